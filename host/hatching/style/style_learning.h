#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/hatching/measurement/drawing_properties.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/features/pixel_features.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

struct StyleLearningOptions {
    std::size_t orientation_samples = 20'000;  ///< at most so many pixels learn directions and segments
    std::size_t samples = 16'000;              ///< the same for each classifier and property
    std::size_t most_stages = 3;               ///< of the cascade of segment classifiers
    MixtureOptions mixture;
    std::uint64_t seed = 1;
};

/// How well the style fits what was held out of the drawing.
struct StyleReport {
    double orientation_error = 0;                        ///< mean |u - f|^2 of the strokes
    std::vector<double> segment_errors;                  ///< share of pixels held out, per stage of the cascade
    double boundary_error = 0, level_error = 0;          ///< likewise
    std::array<double, k_stroke_properties> property{};  ///< root mean square of the error of log y
    std::vector<std::pair<std::string, double>> seconds;
};

/// Learns a style (thesis Sec. 4.4). `progress` is called with what is being learned, often. Deterministic. Throws
/// DataError if the drawing has next to no strokes on the object, UsageError for images of another size than the view,
/// Interrupted at Ctrl-C.
HatchingStyle learn_hatching_style(
    PixelFeatures& pixels, const DrawingProperties& drawing, StumpScorer& scorer, const StyleLearningOptions& options,
    StyleReport& report, const std::function<void(const char*)>& progress = [](const char*) {});

}  // namespace exemplar
