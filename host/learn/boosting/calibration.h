#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// How held-out scores H become probabilities, and how good those are.
struct Calibration {
    Link link = Link::softmax;
    float scale = 1;   ///< the link's s
    double loss = 0;   ///< weighted mean of -log P'(truth), see calibrate
    double error = 0;  ///< weighted share of rows whose largest H is not their label, in [0, 1]
};

/// Finds the link (of `links`) and its scale, in [0.02, 10], that give held-out rows the lowest weighted log loss
/// -log P', P' = 0.99 P + 0.01 / classes: one label in a hundred is taken to be noise, or a few rows that are
/// confidently wrong would decide (a class that a fold never saw has P = 0).
///
/// `scores`: H, rows x classes, item-major; `labels`, `weights`: one per row. Rows of weight zero do not count; if all
/// are zero, or there is no row, loss and error are NaN. The result does not depend on the number of threads.
Calibration calibrate(std::span<const float> scores, std::span<const std::int32_t> labels,
                      std::span<const float> weights, std::size_t classes, std::span<const Link> links);

}  // namespace exemplar
