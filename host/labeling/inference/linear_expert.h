#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"
#include "host/learn/regression/linear_classifier.h"

namespace exemplar {

/// Lower bound of the stumps' probabilities in logarithms: a label that a fold never saw has probability 0.
constexpr float k_min_combined_probability = 1e-6F;

/// A linear classifier that is combined with boosted stumps. Stumps compare single features with thresholds and lose
/// small parts that only many features together show; a linear classifier finds those, but knows no thresholds. The
/// two are combined log-linearly. L_c is fitted to 0 and 1, and clamped, as it may lie far outside on a mesh unlike
/// those of training:
///
///     P_c proportional to exp(scale * (log P_stumps,c + ratio * min(max(L_c, 0), 1)))
///
/// Labels that training saw in one fold only keep the stumps' probabilities: held-out rows cannot show how far to
/// trust L_c for them.
struct LinearExpert {
    LinearClassifier classifier;  ///< its class_count is 0 if there are only stumps
    float ratio = 0;              ///< >= 0
    float scale = 1;              ///< > 0

    bool used() const { return classifier.class_count > 0; }
};

/// Combines the stumps' probabilities (rows x classes), in place, with the linear classifier's scores of these rows;
/// the labels in `unjudged` keep the stumps' probabilities. Does nothing if the classifier is not used. Throws what
/// linear_scores throws.
void pool(const LinearExpert& expert, const FeatureMatrix& features, std::span<const std::uint32_t> stump_only_labels,
          std::span<float> probabilities);

/// One linear classifier per fold, trained without the fold, and the mean of these and one trained on all rows.
struct FoldedLinear {
    LinearExpert mean;
    std::vector<LinearExpert> without_fold;
    double ridge = 0;            ///< see LinearTraining::solve
    double loss = 0, error = 0;  ///< of held-out rows, see calibrate
    double stumps_loss = 0;      ///< the loss of the stumps alone on the same rows
};

/// Fits linear classifiers. Chooses their ridge, ratio and scale by the log loss of held-out rows. Returns nullopt
/// if combining does not lower that loss, or if held-out rows of fewer than two labels have a weight. `stumps`: rows
/// x classes, probabilities of every row of data.features from the stumps that never saw it. `judged`: the weight of
/// each row in the loss. `silent[fold]`: the fold's classifier is left out of the mean, as it does not know all
/// labels.
std::optional<FoldedLinear> fit_linear(const LinearRows& data, std::span<const float> stumps,
                                       std::span<const float> loss_weight, const std::vector<bool>& excluded_folds);

}  // namespace exemplar
