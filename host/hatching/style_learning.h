#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/hatching/hatching_style.h"
#include "host/hatching/pixel_features.h"
#include "host/learn/boosted_stumps.h"

namespace exemplar {

/// What a drawing says of each pixel of the view that it shows; images of the size of the view.
struct DrawingProperties {
    int width = 0, height = 0;
    std::vector<std::uint8_t> center;    ///< 1: on the center line of a stroke: where properties are known
    std::vector<std::uint8_t> crossing;  ///< 1: where strokes cross: the direction is not known
    std::vector<float> orientation;      ///< radians in [0, pi)
    std::array<std::vector<float>, k_stroke_properties> property;  ///< positive where known
    std::vector<std::uint8_t> level;                               ///< of every pixel of the object
    std::vector<std::uint8_t> boundary;                            ///< 1: on a boundary of hatching regions
};

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
