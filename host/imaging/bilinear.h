#pragma once

#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Value of an image beyond its border: zero, or that of the nearest pixel.
enum class ImageBorder { zero, nearest };

/// Interpolates the first channel bilinearly at a place in pixels; the center of pixel (x, y) lies at (x + 0.5,
/// y + 0.5). The image has at least one pixel.
float sample_bilinear(const FloatImage& image, const Vec2& place, ImageBorder border);

}  // namespace exemplar
