#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/learn/boosted_stumps.h"
#include "host/learn/feature_matrix.h"
#include "host/learn/quantize.h"

namespace exemplar {

/// Which held-out measure decides when to stop: the boosting cost itself (Eq. 3.5, Sec. 3.3.1), or the share of wrong
/// labels (Sec. 2.4.2), which a few items that are confidently wrong cannot dominate.
enum class BoostMonitor { loss, error };

/// How JointBoost trains (thesis Sec. 3.3.1).
struct BoostOptions {
    std::size_t rounds = 300;   ///< most stumps
    std::size_t patience = 50;  ///< stop after so many rounds without a lower validation measure; 0 = run all
    BoostMonitor monitor = BoostMonitor::loss;
    bool keep_best = true;  ///< drop the stumps after the lowest validation measure
    std::size_t exhaustive_classes =
        6;  ///< all class subsets are tried up to so many classes (at most 10), greedy above
    /// What each stump's a, b and k_c are multiplied with, in (0, 1]: smaller steps need more rounds and generalize
    /// better where the training rows are few and alike (Friedman 2001).
    double shrinkage = 1.0;
    double feature_fraction = 1.0;  ///< share of the features tried each round, drawn at random, in (0, 1]
    double row_fraction = 1.0;      ///< share of the rows that choose the stump each round, in (0, 1]
    std::uint64_t seed = 1;
};

/// Training pairs (x_i, c_i) with weights. All spans are indexed by the rows of `features`.
struct TrainingSet {
    const QuantizedFeatures& features;
    std::span<const std::int32_t> labels;  ///< class of each row
    std::span<const float> weights;        ///< w_i, one per row, or w_{i,c}, rows x classes; not negative
    std::span<const std::uint32_t> rows;   ///< the rows to use; empty = all
};

/// Held-out pairs, as floats, so that they may come from other meshes or be other rows of the training matrix.
struct ValidationSet {
    const FeatureMatrix& features;
    std::span<const std::int32_t> labels;
    std::span<const float> weights;
    std::span<const std::uint32_t> rows;
};

/// What was measured after a round. Losses are Eq. 3.5 over the sum of all w_{i,c}, so no stumps at all give 1.
struct BoostRound {
    double train_loss;
    double validation_loss;   ///< NaN without a validation set
    double validation_error;  ///< weight of the rows whose largest H is not their label, in [0, 1]; NaN without one
};

struct BoostResult {
    BoostedStumps classifier;
    std::vector<BoostRound> curve;  ///< all rounds that ran, also those whose stumps were dropped
    std::size_t best_rounds = 0;    ///< rounds of the lowest monitored measure (all rounds without a validation set)
};

/// Called after each round with what the round gave and the classifier so far.
using BoostCallback = std::function<void(const BoostRound&, const BoostedStumps&)>;

/// Trains a JointBoost classifier (thesis Sec. 2.4.2, Eqs. 2.64-2.69, 3.5-3.7; Torralba et al. 2007): each round adds
/// the stump shared by a subset of classes that minimizes the weighted squared error (Eq. 3.6). Probabilities:
/// Link::softmax or Link::sigmoid. A class without training rows is never shared: it gets k_c = -1 each round.
/// `validation` may be null; then all rounds are run and kept. The result depends on the data, the options and the
/// seed, not on the number of threads. Throws UsageError for options, labels or sizes out of range, DataError for
/// weights that are negative, not finite or all zero, and Interrupted on Ctrl-C.
BoostResult train_jointboost(const TrainingSet& training, std::size_t class_count, const ValidationSet* validation,
                             const BoostOptions& options, const BoostCallback& callback = {});

/// Trains a binary classifier by GentleBoost (Friedman et al. 2000; thesis Sec. 2.4.1) on labels 0 and 1. The stumps of
/// its one H belong to class 1, class 0 stays at zero: P(1) = sigma(2 H) is Link::softmax with scale 2. Weights are one
/// per row. Otherwise as train_jointboost, with the loss sum_i w_i exp(-z_i H) over the sum of w_i, z = +1 for label 1.
BoostResult train_gentleboost(const TrainingSet& training, const ValidationSet* validation, const BoostOptions& options,
                              const BoostCallback& callback = {});

/// Losses and errors of every prefix of a classifier on held-out pairs; train_loss is NaN. `gentle`: the classifier is
/// from train_gentleboost.
std::vector<BoostRound> validation_curve(const BoostedStumps& classifier, const ValidationSet& validation,
                                         bool gentle = false);

/// The classifier of the first `rounds` rounds (all, if there are fewer).
BoostedStumps truncate(const BoostedStumps& classifier, std::size_t rounds);

}  // namespace exemplar
