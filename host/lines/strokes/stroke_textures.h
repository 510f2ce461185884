#pragma once

#include <span>
#include <string>
#include <string_view>

#include "host/imaging/image.h"

namespace exemplar {

/// Names of the textures that need no file.
std::span<const std::string_view> stroke_texture_names();

/// A texture by the name of a style: how opaque a stroke is, as a gray image (255 is opaque) whose x runs along the
/// stroke, a pixel of the image a pixel of the picture, again and again, and whose y runs across it, from its left
/// side to its right. Of "none" an empty image. Built-in ones are 256 x 32 and always the same; else the name is the
/// path of a PNG file: its alpha, or how dark it is if it has none. Throws DataError as read_png.
Image load_stroke_texture(const std::string& name);

/// The opacity, in [0, 1], at a parameter (pixels along the stroke) and a place across it (-1 left to 1 right):
/// interpolated between pixels, around the ends of x and not beyond those of y. 1 for an empty image.
float sample_stroke_texture(const Image& texture, float parameter, float across);

}  // namespace exemplar
