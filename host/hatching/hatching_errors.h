#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/measurement/drawing_properties.h"

namespace exemplar {

/// Errors of predicted fields against those of a known rule.
struct HatchingErrors {
    std::size_t pixels = 0;     ///< number of the object's pixels
    double orientation = 0;     ///< median, degrees: hatches where truth has any, cross-hatches where both have
    double level_accuracy = 0;  ///< share of the object's pixels whose level is right
    double majority_level = 0;  ///< share of the most common level: the accuracy of a constant guess
    std::array<double, k_stroke_properties> property{};  ///< medians of |y / truth - 1| where truth has strokes
};

/// Compares fields over `pixels` (indices y * width + x). Throws UsageError if sizes differ.
HatchingErrors compare_hatching(const HatchingFields& fields, const HatchingFields& truth,
                                std::span<const std::uint32_t> pixels);

}  // namespace exemplar
