#include "host/hatching/view_hatching.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "host/core/stopwatch.h"
#include "host/hatching/features/line_directions.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/refinement/stroke_relaxation.h"
#include "host/hatching/refinement/tone_matching.h"
#include "host/lines/extraction/drawable_surface.h"

namespace exemplar {

ViewHatching hatch_view(const HatchingStyle& style, PixelFeatures& pixels, const HatchingTools& tools,
                        const HatchingOptions& options, std::span<const HatchStroke> kept) {
    Stopwatch watch;
    ViewHatching out;
    out.prediction = predict_hatching(style, pixels, tools.scorer, tools.evaluator);
    out.prediction_seconds = watch.wall();
    watch = {};
    const HatchingFields& fields = out.prediction.fields;
    const auto barriers = occlusion_barriers(pixels.gbuffer().depth, fields.width, fields.height);
    // Strokes of the previous frame are evenly spaced already; relaxing them again would make them slip on the
    // surface.
    out.strokes = kept.empty() ? place_evenly(tools.placer, fields, barriers, options.strokes)
                               : tools.placer.place(fields, barriers, options.strokes, kept);
    if (options.matches_tone) match_tone(out.strokes, fields);
    out.stroke_seconds = watch.wall();
    return out;
}

Drawing feature_curves(const HatchingSurface& surface, const HatchingView& view, std::span<const LineType> types,
                       const DrawingStyle& style, float unit_depth) {
    StrokeView stroke_view{view.camera, view.width, view.height, unit_depth, surface.feature_size};
    if (!(unit_depth > 0)) {
        const BoundingBox box = bounding_box(surface.mesh);
        const Vec3 middle = (0.5 * (box.low + box.high)).cast<float>();
        stroke_view.unit_depth = std::max(-(view.camera.view * middle.homogeneous()).z(), 1e-20f);
    }
    DrawableSurface cut(surface.mesh.faces, surface.mesh.vertices,
                        {.crease_angle = style.thresholds(LineType::creases).crease_angle});
    cut.take(surface.mesh.vertices, surface.normals, surface.line_curvature);
    return draw_lines(cut.surface(), types, style, stroke_view);
}

}  // namespace exemplar
