#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/measurement/drawing_properties.h"

namespace exemplar {

/// A rule for the direction of strokes that somebody picks, rather than learns (thesis Fig. 4.1b-d).
struct HandPickedRule {
    std::string_view name;       ///< "principal curvature" and so on
    std::string_view direction;  ///< of orientation_feature_names()
};
/// Returns the three of the figure: the direction of largest curvature and the first axis of local patches, both at
/// the largest scale, where they are smoothest, and the gradient of the shaded picture.
std::span<const HandPickedRule> hand_picked_rules();

/// Computes the targets of such a rule for the view of a drawing: the tone follows from thresholds of N.V, which give
/// as many pixels to each hatching level as the drawing does; hatches are crossed at right angles. Thickness,
/// intensity, spacing and length are the drawing's medians everywhere. Pixels without a direction are not hatched.
HatchingFields hatching_by_hand_picked_rule(const HandPickedRule& rule, PixelFeatures& pixels,
                                            const DrawingProperties& drawing);

}  // namespace exemplar
