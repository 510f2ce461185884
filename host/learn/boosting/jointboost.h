#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/boosting/quantize.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// How JointBoost trains (thesis Sec. 3.3.1).
struct BoostOptions {
    std::size_t rounds = 300;  ///< stumps that train_jointboost and train_gentleboost add
    std::size_t exhaustive_classes =
        6;  ///< all class subsets are tried up to this many classes (at most 10), a greedy search above
    /// Factor on each stump's a, b and k_c, in (0, 1]: smaller steps need more rounds and generalize better if the
    /// training rows are few and alike (Friedman 2001).
    double shrinkage = 1.0;
    double feature_fraction = 1.0;  ///< share of the features tried each round, drawn at random, in (0, 1]
    std::uint64_t seed = 1;
};

/// Training pairs (x_i, c_i) with weights. All spans are indexed by the rows of `features`.
struct TrainingSet {
    const QuantizedFeatures& features;
    std::span<const std::int32_t> labels;  ///< class of each row
    std::span<const float> weights;        ///< w_i, one per row, or w_{i,c}, rows x classes; not negative
    std::span<const std::uint32_t> rows;   ///< the rows to use; empty = all
};

/// A classifier that grows by one stump per call. JointBoost (thesis Sec. 2.4.2, 3.3.1, Eqs. 2.64-2.69, 3.5-3.7;
/// Torralba et al. 2007): each round adds the stump, shared by a subset of classes, that minimizes the weighted
/// squared error (Eq. 3.6); probabilities are by Link::softmax or Link::sigmoid. Or GentleBoost (Friedman et al.
/// 2000; thesis Sec. 2.4.1). A class without training rows is never shared: it gets k_c = -1 each round. The result
/// depends on the data, the options and the seed, not on the number of threads.
class Booster {
  public:
    /// JointBoost. Keeps a reference to `training.features`. Throws UsageError for options, labels or sizes out of
    /// range, DataError for weights that are negative, not finite or all zero.
    Booster(const TrainingSet& training, std::size_t class_count, const BoostOptions& options);
    /// GentleBoost on labels 0 and 1. The stumps of its one H belong to class 1, class 0 stays at zero: P(1) =
    /// sigma(2 H) is Link::softmax with scale 2. Weights are one per row. Otherwise as JointBoost, with the loss
    /// sum_i w_i exp(-z_i H) over the sum of w_i, z = +1 for label 1.
    static Booster gentle(const TrainingSet& training, const BoostOptions& options);
    Booster(Booster&&) noexcept;
    Booster& operator=(Booster&&) noexcept;
    ~Booster();

    /// Adds the best stump and returns the training loss after it (Eq. 3.5 over the sum of all w_{i,c}: 1 without
    /// stumps).
    double add_stump();
    const BoostedStumps& classifier() const;

  private:
    class Run;
    explicit Booster(std::unique_ptr<Run> run);
    std::unique_ptr<Run> run_;
};

struct BoostResult {
    BoostedStumps classifier;
    std::vector<double> loss;  ///< training loss after each round
};

/// Run all rounds of a Booster. Throw Interrupted on Ctrl-C.
BoostResult train_jointboost(const TrainingSet& training, std::size_t class_count, const BoostOptions& options);
BoostResult train_gentleboost(const TrainingSet& training, const BoostOptions& options);

/// Returns the classifier of the first `rounds` rounds (all, if there are fewer).
BoostedStumps truncate(const BoostedStumps& classifier, std::size_t rounds);

}  // namespace exemplar
