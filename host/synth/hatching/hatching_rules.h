#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/features/pixel_features.h"

namespace exemplar {

/// How a view is to be hatched by a rule that is known everywhere.
struct RuledHatching {
    HatchingFields fields;
    std::vector<std::uint8_t> segment;  ///< of each pixel: which of the style's rules; 255 outside of the object
};

/// The styles that hatching_by_rule knows:
/// - "contour": hatches along the direction of largest curvature, as rings around limbs; cross-hatching in the dark;
///   darker is denser and thicker.
/// - "light": strokes towards the light, crossed in hollows; spacing follows the light, tone the brightness, length the
///   angle to the eye.
/// - "parts": thick parts along their axis and crossed, thin parts around; thickness from curvature.
/// - "flow": strokes between two directions, pale in the distance, without cross-hatching.
std::span<const std::string_view> hatching_rule_names();

/// The targets of a style for a view. Lengths are given for pictures of 1000 pixels and go with the smaller side,
/// down to 70%.
/// Throws UsageError for an unknown style.
RuledHatching hatching_by_rule(std::string_view style, PixelFeatures& pixels);

}  // namespace exemplar
