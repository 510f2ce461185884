#include "apps/viewer/window/save_svg.h"

#include <algorithm>

#include "apps/viewer/scene/surface_scene.h"
#include "host/core/errors.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/extraction/cut_surface.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {
namespace {

VertexCurvature learned_curvature(const ViewerState& state, const SurfaceShape& shape, std::span<const Vec3> vertices,
                                  std::span<const Vec3> normals) {
    CurvatureEvaluator evaluator(*state.model());
    return evaluator.evaluate(state.document().animation.rig, shape, vertices, normals);
}

/// The surface at one frame, on the host.
struct HostFrame {
    const std::vector<Face>& faces;
    std::vector<Vec3> vertices;
    CurvatureEstimator estimator;
    VertexCurvature estimated;

    HostFrame(const ViewerState& state, const SurfaceShape& shape)
        : faces(state.document().animation.rest.faces),
          vertices(vertices_of(state.document().animation, shape)),
          estimator(faces, vertices.size()),
          estimated(estimator.estimate(vertices, measuring_options(state.model().get()))) {}

    Drawing draw(const ViewerState& state, const VertexCurvature& curvature, ViewSize size) const {
        const StrokeView view{
            .camera = state.camera.camera(size),
            .width = size.width,
            .height = size.height,
            .unit_depth = state.camera.distance(),
            .feature_size = state.model() ? state.model()->feature_size : feature_size(vertices, curvature)};
        const DrawingStyle& style = state.settings.style;
        const CutSurface cut(faces, vertices, estimator.normals(), curvature,
                             style.thresholds(LineType::creases).crease_angle);
        return draw_lines(cut.surface(), state.settings.shown_lines(), style, view);
    }
};

Drawing drawing_of(const ViewerState& state, ViewSize size) {
    const SurfaceShape shape = state.shape();
    const HostFrame saved(state, shape);
    if (!state.model() || state.settings.source == ShownCurvature::estimated)
        return saved.draw(state, saved.estimated, size);
    const VertexCurvature learned = learned_curvature(state, shape, saved.vertices, saved.estimator.normals());
    if (!state.shows_both()) return saved.draw(state, learned, size);
    const ViewSize left{std::max(size.width / 2, 1), size.height};
    const ViewSize right{std::max(size.width - left.width, 1), size.height};
    return side_by_side(saved.draw(state, learned, left), saved.draw(state, saved.estimated, right));
}

}  // namespace

void save_svg(const std::filesystem::path& path, const ViewerState& state, ViewSize size) {
    const ViewSettings& settings = state.settings;
    if (!settings.shows_lines()) throw UsageError("no lines are shown that an SVG file could hold; choose some");
    DrawingStyle style = settings.style;
    style.background = settings.background;
    const Drawing drawing = drawing_of(state, size);
    write_drawing_svg(path, {&drawing, 1}, style, {.curves = true, .title = state.document().animation.name});
}

}  // namespace exemplar
