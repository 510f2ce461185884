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
    std::span<const std::int32_t> labels;    ///< of each row
    std::span<const float> weights;          ///< of each row; empty: equal
    std::span<const std::uint8_t> held_out;  ///< of each row
    std::size_t classes = 2;
    bool gentle = false;  ///< GentleBoost for two classes in place of JointBoost
    std::size_t most_rounds = 500;
    std::uint64_t seed = 1;
};

struct LearnedClassifier {
    CalibratedStumps classifier;  ///< its features are expanded ones, see powers.h
    double error = 0;             ///< share of rows held out (by weight) that it gets wrong
    double loss = 0;              ///< their log loss
};

/// Boosts until the rows held out are told best (thesis Sec. 4.4.2): the log loss decides, as it also sees how sure the
/// classifier is, which the graph cut relies on. One class only: no stumps.
LearnedClassifier learn_classifier(
    const ClassifierTraining& training, const std::function<void()>& progress = [] {});

/// Probabilities of rows (rows x classes) whose base features `which` are `base`.
std::vector<float> classify(const CalibratedStumps& classifier, std::span<const std::uint32_t> which,
                            const FeatureMatrix& base, StumpScorer& scorer);

/// Contextual features (thesis Eq. 4.15): for each label and range of geodesic distance the mean probability of that
/// label over the visible pixels in that range, normalized to a sum of 1 over all. Before them, beyond the thesis, as
/// range 0 the probabilities of the pixel itself: properties may change with the segment at once. (1 + 4) x labels
/// columns, the range the slower. `probabilities`: of each covered pixel x labels. Distances are those between faces on
/// the surface.
FeatureMatrix contextual_features(const HatchingSurface& surface, const GBuffer& gbuffer, const CoveredPixels& pixels,
                                  std::span<const float> probabilities, std::size_t labels,
                                  std::span<const std::uint32_t> rows);
/// Their names: "context.LABEL.RANGE", labels from 1, and their number.
std::vector<std::string> contextual_feature_names(std::size_t labels);
constexpr std::size_t contextual_feature_count(std::size_t labels) {
    return labels < 2 ? 0 : (1 + k_context_ranges) * labels;
}

}  // namespace exemplar
