#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/lines/line_renderer.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// The part of a style that the device draws with.
struct DeviceStyle {
    FamilyThresholds thresholds{};
    StrokeLooks looks{};
    PaintLook surface;
    std::vector<std::uint8_t> textures;  ///< for LineRenderer::set_textures
};

/// Converts a style. Throws DataError if a texture cannot be read.
DeviceStyle device_style(const DrawingStyle& style);

/// Sets the families, thresholds, looks and surface of a picture of lines of these types; textures are not set.
void apply_style(const DeviceStyle& style, std::span<const LineType> types, LinePicture& picture);

}  // namespace exemplar
