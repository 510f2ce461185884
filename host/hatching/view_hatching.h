#pragma once

#include <span>
#include <vector>

#include "host/hatching/features/image_tools.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/placement/streamlines.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/style/style_prediction.h"

namespace exemplar {

/// The implementations that hatching uses, each on the CPU or on a device.
struct HatchingTools {
    ImageTools& images;
    StumpScorer& scorer;
    HatchingEvaluator& evaluator;
    StrokePlacer& placer;
};

/// Options of hatch_view().
struct HatchingOptions {
    StrokeOptions strokes;
    bool matches_tone = true;  ///< whether match_tone() adapts the widths of strokes
};

/// The strokes of a view in a style, not tapered, and the prediction that they were placed from.
struct ViewHatching {
    HatchingPrediction prediction;
    std::vector<HatchStroke> strokes;
    double prediction_seconds = 0, stroke_seconds = 0;  ///< wall time
};

/// Hatches a view in a style. `kept`: strokes of the previous frame, see StrokePlacer; without any, the strokes are
/// spaced by place_evenly(). Throws as predict_hatching and StrokePlacer::place.
ViewHatching hatch_view(const HatchingStyle& style, PixelFeatures& pixels, const HatchingTools& tools,
                        const HatchingOptions& options = {}, std::span<const HatchStroke> kept = {});

/// Draws the feature curves of a surface in a view. `unit_depth`: see StrokeView; 0 stands for the depth of the
/// center of the surface's bounding box. Throws as draw_lines.
Drawing feature_curves(const HatchingSurface& surface, const HatchingView& view, std::span<const LineType> types,
                       const DrawingStyle& style, float unit_depth = 0);

}  // namespace exemplar
