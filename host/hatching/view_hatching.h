#pragma once

#include <span>
#include <vector>

#include "host/hatching/hatching_drawing.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/features/image_tools.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/placement/streamlines.h"
#include "host/hatching/style/style_prediction.h"

namespace exemplar {

/// What hatches pictures: on the host, or on a device.
struct HatchingTools {
    ImageTools& images;
    StumpScorer& scorer;
    HatchingEvaluator& evaluator;
    StrokePlacer& placer;
};

/// How a view is hatched.
struct HatchingOptions {
    StrokeOptions strokes;
    bool matches_tone = true;  ///< see match_tone()
};

/// Strokes in a style, not tapered, and what they were placed by.
struct ViewHatching {
    HatchingPrediction prediction;
    std::vector<HatchStroke> strokes;
    double prediction_seconds = 0, stroke_seconds = 0;  ///< wall time
};

/// Hatches a view in a style. `kept`: see StrokePlacer; without, strokes are spaced as place_evenly() does. Throws as
/// predict_hatching and StrokePlacer::place.
ViewHatching hatch_view(const HatchingStyle& style, PixelFeatures& pixels, const HatchingTools& tools,
                        const HatchingOptions& options = {}, std::span<const HatchStroke> kept = {});

/// The feature curves of a surface in a view. `unit_depth`: StrokeView's; 0: the depth of the surface's middle. Throws
/// as draw_lines.
Drawing feature_curves(const HatchingSurface& surface, const HatchingView& view, std::span<const LineType> types,
                       const DrawingStyle& style, float unit_depth = 0);

}  // namespace exemplar
