#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"
#include "host/learn/regression/linear_classifier.h"

namespace exemplar {

/// What a linear classifier adds to the probabilities of boosted stumps. Stumps tell labels apart by thresholds of
/// single features and lose small parts that only many features together show; a linear classifier finds those, and
/// knows no thresholds. The two are pooled by their logarithms: P_c is proportional to
/// exp(scale * (log P_stumps,c + ratio * min(max(L_c, 0), 1))): L_c is fitted to 0 and 1, and on a mesh unlike those of
/// training it may lie far beyond. Labels that training saw in one fold alone keep what the stumps say: how much to
/// believe L_c of them cannot be judged on held-out rows.
struct LinearOpinion {
    LinearClassifier classifier;  ///< its class_count is 0 where the stumps alone count
    float ratio = 0;              ///< >= 0
    float scale = 1;              ///< > 0

    bool used() const { return classifier.class_count > 0; }
};

/// Pools the stumps' probabilities (rows x classes) with what the linear classifier says of these rows, but for the
/// labels in `unjudged`; nothing changes if it is not used. Throws what linear_scores throws.
void pool(const LinearOpinion& opinion, const FeatureMatrix& features, std::span<const std::uint32_t> unjudged,
          std::span<float> probabilities);

/// A linear classifier per fold, which never saw the fold, and their mean with that of all rows.
struct FoldedLinear {
    LinearOpinion mean;
    std::vector<LinearOpinion> without_fold;
    double ridge = 0;            ///< see LinearTraining::solve
    double loss = 0, error = 0;  ///< of held-out rows, see calibrate
    double stumps_loss = 0;      ///< the loss of the stumps alone on the same rows
};

/// Fits linear classifiers, and chooses their ridge and how they are pooled by the log loss of held-out rows; none if
/// pooling does not lower that loss, or no two labels can be judged. `stumps`: probabilities of every row of
/// data.features from the stumps that never saw it, rows x classes. `judged`: the weight of each row in the loss.
/// `silent[fold]`: that fold's classifier has no say in the mean, as it does not know all labels.
std::optional<FoldedLinear> fit_linear(const LinearRows& data, std::span<const float> stumps,
                                       std::span<const float> judged, const std::vector<bool>& silent);

}  // namespace exemplar
