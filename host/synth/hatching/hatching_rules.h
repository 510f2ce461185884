#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// The hatching of a view by a rule, known at every pixel.
struct RuledHatching {
    HatchingFields fields;
    std::vector<std::uint8_t> segment;  ///< per pixel: index of the style's rule that applies; 255 outside of the
                                        ///< object
};

/// Returns the styles that hatching_by_rule knows:
/// - "contour": hatches along the direction of largest curvature, as rings around limbs; cross-hatching in the dark;
///   darker is denser and thicker.
/// - "light": strokes towards the light, crossed in hollows. Spacing follows the light, tone the brightness, length
///   the angle to the eye.
/// - "parts": thick parts along their axis and crossed, thin parts around; thickness from curvature.
/// - "flow": strokes between two directions, pale in the distance, without cross-hatching.
std::span<const std::string_view> hatching_rule_names();

/// Computes the targets of a style for a view. Lengths are defined for pictures of 1000 pixels and scale with the
/// smaller side, down to 70%. Throws UsageError for an unknown style.
RuledHatching hatching_by_rule(std::string_view style, PixelFeatures& pixels);

}  // namespace exemplar
