#pragma once

#include <span>
#include <string>
#include <string_view>

#include "host/imaging/image.h"

namespace exemplar {

/// Returns the names of the built-in textures.
std::span<const std::string_view> stroke_texture_names();

/// Returns the texture with the name that a style gives: the opacity of a stroke as a gray image (255 is opaque). x
/// runs along the stroke, one texel per pixel of the picture, and repeats; y runs across, from left to right. "none"
/// is an empty image; built-in textures are 256 x 32. Other names are paths of PNG files, of which alpha or, without
/// alpha, darkness is taken. Throws DataError as read_png does.
Image load_stroke_texture(const std::string& name);

/// Returns the opacity in [0, 1] at a parameter (pixels along the stroke) and a position across it (-1 left to 1
/// right), by bilinear interpolation that repeats in x and clamps in y. 1 for an empty image.
float sample_stroke_texture(const Image& texture, float parameter, float across);

}  // namespace exemplar
