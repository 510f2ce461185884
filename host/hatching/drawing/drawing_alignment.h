#pragma once

#include "host/hatching/drawing/drawing_warp.h"
#include "host/imaging/image.h"

namespace exemplar {

struct AlignmentOptions {
    float max_tilt = 0.21f;       ///< max tilt of the sheet to either side, radians
    bool quarter_turns = true;    ///< whether it may be rotated by quarter turns, too
    float min_explained = 0.38f;  ///< min share of the object's border that the drawing's lies on
    float max_outside = 0.15f;    ///< max share of the ink outside of the object
};

/// The placement of a drawing over the view it was made for.
struct DrawingAlignment {
    Similarity to_view;       ///< from pixels of the drawing to pixels of the view
    float residual = 0;       ///< view pixels: RMS distance of the borders where they lie on each other
    float explained = 0;      ///< share of the object's border where they do
    float outside = 0;        ///< share of the ink that lies outside of the object
    bool same_frame = false;  ///< the drawing was taken to show the whole view, as tablets make them
};

/// Finds the placement of a drawing over a view in which the object covers the nonzero pixels of `object`, by
/// brute-force matching of borders (thesis App. B.1). `darkness`: see drawing_darkness; any resolution and margins,
/// tilted a little, rotated by quarter turns; lit parts may be blank. A drawing of the view's aspect ratio is only
/// scaled to the view's size unless another placement is clearly better. A border without corners leaves the
/// rotation undetermined. Throws UsageError if an image has not one channel or the object no pixel, DataError for a
/// drawing without ink, and for one that fits nowhere.
DrawingAlignment align_drawing(const FloatImage& darkness, const Image& object, const AlignmentOptions& options = {});

}  // namespace exemplar
