#pragma once

#include "host/imaging/image.h"

namespace exemplar {

/// How dark each pixel of a drawing is, from 0 (paper) to 1 (black): one channel of the same size. Where noise makes
/// paper lighter than it is, darkness is a little below 0: cut off there, it would be too dark on average. The drawing
/// is gray, RGB or RGBA (seen over white), dark strokes on light paper, drawn in software or scanned. Darkness is one
/// less the encoded (sRGB) gray over that of the paper, as the eye and drawing programs have it. The paper of a scan is
/// gray, uneven and noisy: its level is a quadratic function of the position, fitted to the pixels that are near it, so
/// neither strokes nor noise pull it. Throws UsageError for an empty image or another number of channels, DataError if
/// there are no strokes, or no paper around them.
FloatImage drawing_darkness(const Image& drawing);

}  // namespace exemplar
