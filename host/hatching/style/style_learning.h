#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/hatching/rules/hatching_examples.h"
#include "host/hatching/style/hatching_style.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

struct StyleLearningOptions {
    std::size_t orientation_samples = 20'000;  ///< pixels for learn_mixture(), at most
    std::size_t samples = 16'000;              ///< pixels for each classifier and property, at most
    std::size_t max_stages = 3;                ///< of the cascade of segment classifiers
    std::uint64_t seed = 1;                    ///< of all random choices
    /// Learns without segmentation, for comparison (thesis Fig. 4.1e): one rule of directions for the whole drawing,
    /// without corrections, and no contextual features.
    bool one_rule = false;
};

/// Errors of a style on its drawing: of classifiers and properties on held-out pixels.
struct StyleReport {
    double orientation_error = 0;  ///< mean |u - f|^2 of the strokes
    /// The segments that the mixture found (thesis Fig. 4.3a): an image per drawing, known at sampled pixels of center
    /// lines, k_no_segment elsewhere.
    std::vector<std::vector<std::uint8_t>> segments;
    /// Mean |u - f|^2 of held-out strokes by the rules alone and with the correction, per layer; zero: no correction.
    std::array<std::array<double, 2>, k_hatch_layers> direction_errors{};
    std::vector<double> segment_errors;                  ///< share of wrong held-out pixels, per stage of the cascade
    double boundary_error = 0, level_error = 0;          ///< likewise
    std::array<double, k_stroke_properties> property{};  ///< root mean square error of log y
    std::vector<std::pair<std::string, double>> seconds;
};

/// Learns a style (thesis Sec. 4.4) from one or more drawings by the same hand. Lengths are in pixels of
/// the first drawing; see HatchingStyle::resize() for drawings of other sizes. Calls `progress` often, with the name of
/// the current step. Deterministic. Throws DataError if the drawings have too few strokes on the objects, UsageError as
/// HatchingExamples does, and Interrupted at Ctrl-C.
HatchingStyle learn_hatching_style(
    std::span<const HatchingExample> views, StumpScorer& scorer, const StyleLearningOptions& options,
    StyleReport& report, const std::function<void(const char*)>& progress = [](const char*) {});
/// Learns from one drawing.
inline HatchingStyle learn_hatching_style(
    PixelFeatures& pixels, const DrawingProperties& drawing, StumpScorer& scorer, const StyleLearningOptions& options,
    StyleReport& report, const std::function<void(const char*)>& progress = [](const char*) {}) {
    const HatchingExample view{pixels, drawing};
    return learn_hatching_style(std::span(&view, 1), scorer, options, report, progress);
}

}  // namespace exemplar
