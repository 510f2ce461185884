#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

struct ClassifierTraining {
    const FeatureMatrix& features;           ///< base features of the rows
    std::span<const std::int32_t> labels;    ///< per row
    std::span<const float> weights;          ///< per row; empty: equal
    std::span<const std::uint8_t> held_out;  ///< per row, 1: only for validation
    std::size_t classes = 2;
    bool gentle = false;  ///< GentleBoost for two classes instead of JointBoost
    std::size_t max_rounds = 500;
    std::uint64_t seed = 1;
    /// For labels with details that many small steps can learn: each round searches a random fifth of the features, and
    /// boosting goes on for as long as the share of wrong held-out rows stays within a standard error of the lowest.
    bool detailed = false;
};

struct LearnedClassifier {
    CalibratedStumps classifier;  ///< over expanded features, see powers.h
    CalibratedStumps judged;      ///< the same, not learned from the held-out rows
    double error = 0;             ///< share (by weight) of held-out rows that it gets wrong
    double loss = 0;              ///< log loss of the held-out rows
};

/// Boosts until the held-out rows fit best (thesis Sec. 4.4.2), then learns again from all rows with that number of
/// rounds. The log loss decides, as it also measures confidence,
/// unless labels are detailed. Returns no stumps
/// for a single class.
LearnedClassifier learn_classifier(
    const ClassifierTraining& training, const std::function<void()>& progress = [] {});

/// Returns, for each fold, the classifier that has learned from the rows of all other folds as `like` has from all: in
/// as many rounds, with the same link. `fold`: per row, below `folds`.
std::vector<CalibratedStumps> learn_without_folds(
    const ClassifierTraining& training, const CalibratedStumps& like, std::span<const std::uint8_t> fold,
    std::size_t folds, const std::function<void()>& progress = [] {});

/// Returns the class probabilities of rows (rows x classes). `base` holds their base features, numbered `which`.
std::vector<float> classify(const CalibratedStumps& classifier, std::span<const std::uint32_t> which,
                            const FeatureMatrix& base, StumpScorer& scorer);

/// Computes the contextual features of thesis Eq. 4.15: for each label and range of geodesic distance between faces,
/// the mean probability of that label over the visible pixels in that range, normalized to a sum of 1 over all.
/// Beyond the thesis, range 0 holds the probabilities of the pixel itself, so that properties can change with the
/// segment at once. Returns (1 + 4) x labels columns, the label varying fastest. `probabilities`: covered pixels x
/// labels. `rows`: numbers of covered pixels; empty: all.
FeatureMatrix contextual_features(const HatchingSurface& surface, const GBuffer& gbuffer, const CoveredPixels& pixels,
                                  std::span<const float> probabilities, std::size_t labels,
                                  std::span<const std::uint32_t> rows);
/// Returns their names, "context.LABEL.RANGE", labels from 1.
std::vector<std::string> contextual_feature_names(std::size_t labels);
/// Returns their number.
constexpr std::size_t contextual_feature_count(std::size_t labels) {
    return labels < 2 ? 0 : (1 + k_context_ranges) * labels;
}

}  // namespace exemplar
