#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gpu/lines/line_renderer.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

/// What of a style the device draws with.
struct DeviceStyle {
    FamilyThresholds thresholds{};
    StrokeLooks looks{};
    PaintLook surface;
    std::vector<std::uint8_t> textures;  ///< for LineRenderer::set_textures
};

/// Throws DataError if a texture cannot be read.
DeviceStyle device_style(const DrawingStyle& style);

/// Puts all of it but the textures into a picture of lines of these types.
void apply_style(const DeviceStyle& style, std::span<const LineType> types, LinePicture& picture);

}  // namespace exemplar
