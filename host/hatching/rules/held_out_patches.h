#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/measurement/drawing_properties.h"

namespace exemplar {

/// Returns 1 for rows of covered pixels that are held out: a quarter of them, in rectangles with sides of three to ten
/// of the drawing's median spacings. That is about as far as a hand goes on as it began, so these rows tell how well
/// the gaps between what was learned from are filled.
std::vector<std::uint8_t> held_out_patches(const PixelFeatures& pixels, const DrawingProperties& drawing,
                                           std::span<const std::uint32_t> rows, std::uint64_t seed);

}  // namespace exemplar
