#pragma once

#include "host/imaging/image.h"

namespace exemplar {

/// Returns the gray of each pixel over white, from 0 (black) to 1, of a picture that is gray, RGB or RGBA.
FloatImage gray_over_white(const Image& picture);

/// Returns the darkness of each pixel of a drawing, from 0 (paper) to 1 (black): one channel of the same size. The
/// drawing is gray, RGB or RGBA (over white): dark strokes on light paper, drawn in software or scanned. Darkness is
/// 1 - gray / paper, in encoded (sRGB) gray, as the eye and drawing programs see it. The paper's gray is a quadratic
/// function of the position, fitted to pixels near it, so that neither strokes nor noise bias it. Noise makes
/// darkness slightly negative; clamped, paper would be too dark on average. Lines in color are left out of a drawing in
/// neutral ink: construction lines, or a view that was printed in pale blue. Throws UsageError for an empty image or
/// another number of channels, DataError if there are no strokes, or no paper around them.
FloatImage drawing_darkness(const Image& drawing);

}  // namespace exemplar
