#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// Confusion matrix: the area of each true class that was given each label.
struct ConfusionMatrix {
    std::size_t classes = 0;
    std::vector<double> area;         ///< classes x (classes + 1): row = truth; last column = none of the labels
    std::vector<std::size_t> counts;  ///< items per true class, so that a class without area still counts as present

    double at(std::size_t truth, std::size_t predicted) const { return area[truth * (classes + 1) + predicted]; }
};

/// Computes the confusion matrix. Ignores items whose truth is -1; a prediction outside of 0 .. classes - 1 is wrong
/// for every truth. `areas`: one per item (the weight a_i). Throws UsageError for sizes that differ or a truth out
/// of range.
ConfusionMatrix confusion_matrix(std::span<const std::int32_t> truth, std::span<const std::int32_t> predicted,
                                 std::span<const float> areas, std::size_t classes);

/// Returns the share of the area that is labeled correctly, in [0, 1]: one minus the classification error (thesis
/// Eq. 3.8). NaN if there is no area.
double recognition_rate(const ConfusionMatrix& confusion);

/// Returns the share of each class's area that is labeled correctly, averaged over the classes that occur, in [0,
/// 1]: one minus the segment-weighted error (thesis Eq. 3.9) over the number of classes. A class without area counts
/// as wrong. NaN without any items.
double segment_weighted_accuracy(const ConfusionMatrix& confusion);

}  // namespace exemplar
