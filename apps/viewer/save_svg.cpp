#include "apps/viewer/save_svg.h"

#include "host/core/errors.h"
#include "host/lines/drawing_svg.h"
#include "host/mesh/curvature_estimator.h"

namespace exemplar {
namespace {

// As the device measures it; see SurfaceScene.
CurvatureOptions measuring_options(const ViewerState& state) {
    CurvatureOptions options = state.model() ? state.model()->truth : CurvatureOptions{.smoothing = 1};
    options.derivatives = true;
    return options;
}

VertexCurvature shown_curvature(const ViewerState& state, const Moment& moment, std::span<const Vec3> vertices,
                                CurvatureEstimator& estimator) {
    const VertexCurvature& estimated = estimator.estimate(vertices, measuring_options(state));
    if (!state.model() || state.settings.source == ShownCurvature::estimated) return estimated;
    CurvatureEvaluator evaluator(*state.model());
    return moment.pose ? evaluator.evaluate(state.document().animation.rig, *moment.pose, vertices, estimator.normals())
                       : evaluator.evaluate(vertices, estimator.normals());
}

}  // namespace

void save_svg(const std::filesystem::path& path, const ViewerState& state, ViewSize size) {
    const ViewSettings& settings = state.settings;
    if (!settings.shows_lines()) throw UsageError("no lines are shown that an SVG file could hold; choose some");
    const Moment moment = state.moment();
    const std::vector<Face>& faces = state.document().animation.rest.faces;
    const std::vector<Vec3> vertices = vertices_at(state.document(), moment);
    CurvatureEstimator estimator(faces, vertices.size());
    const VertexCurvature curvature = shown_curvature(state, moment, vertices, estimator);
    const std::vector<FaceNeighbors> neighbors = build_face_neighbors(faces, vertices.size());
    const StrokeView view{
        .camera = state.camera.camera(size),
        .width = size.width,
        .height = size.height,
        .unit_depth = state.camera.distance(),
        .feature_size = state.model() ? state.model()->feature_size : feature_size(vertices, curvature)};
    DrawingStyle style = settings.style;
    style.background = settings.background;
    const Drawing drawing =
        draw_lines({faces, vertices, estimator.normals(), curvature, neighbors}, settings.shown_lines(), style, view);
    write_drawing_svg(path, {&drawing, 1}, style, {.curves = true, .title = state.document().animation.name});
}

}  // namespace exemplar
