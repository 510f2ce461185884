#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host/hatching/measurement/drawing_properties.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// How far targets are from those of a known rule.
struct HatchingErrors {
    std::size_t pixels = 0;     ///< of the object
    double orientation = 0;     ///< median, degrees: of hatches where the truth has any, of crossings where both have
    double level_accuracy = 0;  ///< share of the object's pixels
    double majority_level = 0;  ///< share of the commonest level: what a guess would reach
    std::array<double, k_stroke_properties> property{};  ///< medians of |y / truth - 1| where the truth has strokes
};

/// Compares fields over `pixels` (y * width + x). Throws UsageError if sizes differ.
HatchingErrors compare_hatching(const HatchingFields& fields, const HatchingFields& truth,
                                std::span<const std::uint32_t> pixels);

/// Median; 0 without values.
double median_of_values(std::vector<float> values);

}  // namespace exemplar
