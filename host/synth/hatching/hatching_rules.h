#pragma once

#include <span>
#include <string_view>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

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
HatchingFields hatching_by_rule(std::string_view style, PixelFeatures& pixels);

}  // namespace exemplar
