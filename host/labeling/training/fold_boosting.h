#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/labeling/inference/linear_opinion.h"
#include "host/labeling/inference/model.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// The items (faces or edges) of one mesh that a classifier learns from.
struct BoostingItems {
    const FeatureMatrix* features;        ///< at least the columns that are trained on
    std::span<const std::int32_t> label;  ///< per item; -1 is left out
    std::span<const float> weight;        ///< per item
    std::span<const std::uint8_t> fold;   ///< per item: the fold that holds it out
};

struct FoldBoostingOptions {
    std::size_t classes = 2;
    std::size_t features = 0;  ///< leading columns to train on
    std::size_t folds = 1;
    std::size_t rounds = 300, bins = 128;
    /// The number of rounds is that of the lowest held-out loss, which the search leaves so many rounds behind; 0 keeps
    /// all rounds.
    std::size_t patience = 50;
    std::size_t rows_per_mesh = 0;  ///< 0 = all
    double feature_fraction = 1;    ///< share of the features that each round looks at
    double shrinkage = 1;           ///< see BoostOptions
    bool binary = false;            ///< GentleBoost for two classes instead of JointBoost
    bool linear = false;            ///< pool the stumps with a linear classifier where that lowers the held-out loss
    std::uint64_t seed = 1;
};

/// How well held-out items are labeled after so many rounds (see calibrate).
struct HeldOutPoint {
    std::size_t rounds;
    double loss, error;
};

struct FoldBoostingResult {
    CalibratedStumps classifier;  ///< the mean of one trained on all items and those of the folds
    LinearOpinion linear;         ///< what it is pooled with; not used unless options.linear asks for it
    std::size_t rounds = 0;       ///< of each of them
    /// Per mesh: items x classes, from the classifier that never saw the item; for labels that it cannot know, as one
    /// fold has them all, from the mean, with less confidence.
    std::vector<std::vector<float>> out_of_fold;
    std::vector<std::uint32_t> of_one_fold;  ///< the labels that one fold has alone
    std::vector<HeldOutPoint> curve;         ///< up to where the search for the number of rounds ended
    double loss = 0;                         ///< weighted log loss of held-out items; NaN if nothing could be held out
    double error = 0;                        ///< weighted share of wrong labels; likewise
    double stumps_loss = 0;                  ///< the loss of the stumps alone, on the same items
};

/// Boosts one classifier per fold and one on everything (see train_labeling). The log loss of the held-out items, after
/// calibration, chooses the number of rounds (if options.patience asks for that), the link and its scale. The result is
/// the mean of these classifiers, which differ by what they did not see: their mean is better than any one. Those of
/// folds that hold all items of a class have no say: they do not know it.
/// `round_done` is called after every round of every classifier.
FoldBoostingResult boost_with_folds(std::span<const BoostingItems> meshes, const FoldBoostingOptions& options,
                                    StumpScorer& scorer, const std::function<void()>& round_done);

}  // namespace exemplar
