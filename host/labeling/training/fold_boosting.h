#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/labeling/inference/linear_expert.h"
#include "host/labeling/inference/model.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// The items (faces or edges) of one mesh that a classifier is trained on.
struct BoostingItems {
    /// Returns at least the columns to train on. They may be gone when those of another mesh are asked for.
    std::function<const FeatureMatrix&()> features;
    std::span<const std::int32_t> label;  ///< per item; items with -1 are ignored
    std::span<const float> weight;        ///< per item
    std::span<const std::uint8_t> fold;   ///< per item: the fold that holds it out
};

struct FoldBoostingOptions {
    std::size_t classes = 2;
    std::size_t features = 0;  ///< number of leading columns to train on
    std::size_t folds = 1;
    std::size_t rounds = 300, bins = 128;
    /// The number of rounds is the one with the lowest held-out loss; the search stops this many rounds after it. 0
    /// keeps all rounds.
    std::size_t patience = 50;
    /// Items drawn at random per mesh, half of them evenly from its labels; 0 = all. Weights make up for what is not
    /// drawn.
    std::size_t rows_per_mesh = 0;
    double feature_fraction = 1;  ///< share of the features that are tried in each round
    double shrinkage = 1;         ///< see BoostOptions
    bool binary = false;          ///< GentleBoost for two classes instead of JointBoost
    bool linear = false;          ///< combine the stumps with a linear classifier if that lowers the held-out loss
    std::uint64_t seed = 1;
};

/// Loss and error of held-out items after a number of rounds (see calibrate).
struct HeldOutPoint {
    std::size_t rounds;
    double loss, error;
};

struct FoldBoostingResult {
    CalibratedStumps classifier;  ///< the mean of one trained on all items and those of the folds
    LinearExpert linear;          ///< what it is combined with; not used unless options.linear is set
    std::size_t rounds = 0;       ///< of each classifier in the mean
    /// Per mesh: items x classes, from the classifier that never saw the item. Labels that it cannot know, because one
    /// fold has all their items, get the probability of the mean, with less confidence.
    std::vector<std::vector<float>> out_of_fold;
    std::vector<std::uint32_t> single_fold_labels;  ///< labels that occur in one fold only
    std::vector<HeldOutPoint> curve;                ///< up to where the search for the number of rounds ended
    double loss = 0;         ///< weighted log loss of held-out items; NaN if nothing could be held out
    double error = 0;        ///< weighted share of wrong labels; likewise
    double stumps_loss = 0;  ///< the loss of the stumps alone, on the same items
};

/// Boosts one classifier per fold and one on all items (see train_labeling). The log loss of the held-out items, after
/// calibration, chooses the number of rounds (with options.patience), the link and its scale. The result is the mean
/// of these classifiers: each has missed other items, and the mean is better than any of them. Classifiers of folds
/// that hold all items of a class are left out of the mean, as they do not know the class.
/// Calls `round_done` after every round of every classifier.
FoldBoostingResult boost_with_folds(std::span<const BoostingItems> meshes, const FoldBoostingOptions& options,
                                    StumpScorer& scorer, const std::function<void()>& round_done);

}  // namespace exemplar
