#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// The link that turns scores H into probabilities, and its quality on held-out rows.
struct Calibration {
    Link link = Link::softmax;
    float scale = 1;   ///< the link's s
    double loss = 0;   ///< weighted mean of -log P'(truth), see calibrate
    double error = 0;  ///< weighted share of rows whose largest H is not their label, in [0, 1]
};

/// Finds the link (of `links`) and its scale, in [0.02, 10], with the lowest weighted log loss of held-out rows:
/// -log P' with P' = 0.99 P + 0.01 / classes. This treats one label in a hundred as noise; otherwise a few rows that
/// are confidently wrong would decide (a class that a fold never saw has P = 0).
///
/// `scores`: H, rows x classes, item-major; `labels`, `weights`: one per row. Rows of weight zero are ignored; if
/// there are no others, loss and error are NaN. The result does not depend on the number of threads.
Calibration calibrate(std::span<const float> scores, std::span<const std::int32_t> labels,
                      std::span<const float> weights, std::size_t classes, std::span<const Link> links);

}  // namespace exemplar
