#include "apps/viewer/window/save_svg.h"

#include <algorithm>

#include "apps/viewer/scene/surface_scene.h"
#include "host/core/errors.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/extraction/drawable_surface.h"

namespace exemplar {
namespace {

/// Measured as the window shows it.
DrawableOptions drawable_options(const ViewerState& state) {
    return {.curvature = measuring_options(state.model().get()),
            .crease_angle = state.settings.style.thresholds(LineType::creases).crease_angle,
            .cut_curvature = state.settings.shows(LineType::creases)};
}

/// The surface at one frame, on the host.
class HostFrame {
  public:
    HostFrame(const ViewerState& state, const SurfaceShape& shape)
        : vertices_(vertices_of(state.document().animation, shape)),
          surface_(state.document().animation.rest.faces, first_shape(state.document().animation).vertices,
                   drawable_options(state)) {}

    Drawing draw_measured(const ViewerState& state, ViewSize size) {
        surface_.measure(vertices_);
        return draw(state, state.model() ? state.model()->feature_size : surface_.feature_size(), size);
    }
    Drawing draw_learned(const ViewerState& state, const SurfaceShape& shape, ViewSize size) {
        const Animation& animation = state.document().animation;
        const std::vector<Vec3> normals = normals_of(animation.rest.faces);
        CurvatureEvaluator evaluator(*state.model());
        surface_.take(vertices_, normals, evaluator.evaluate(animation.rig, shape, vertices_, normals));
        return draw(state, state.model()->feature_size, size);
    }

  private:
    std::vector<Vec3> normals_of(const std::vector<Face>& faces) const {
        TriangleMesh mesh;
        mesh.vertices = vertices_;
        mesh.faces = faces;
        return vertex_normals(mesh);
    }
    Drawing draw(const ViewerState& state, float feature_size, ViewSize size) const {
        const StrokeView view{.camera = state.camera.camera(size),
                              .width = size.width,
                              .height = size.height,
                              .unit_depth = state.camera.distance(),
                              .feature_size = feature_size};
        return draw_lines(surface_.surface(), state.settings.shown_lines(), state.settings.style, view);
    }
    std::vector<Vec3> vertices_;
    DrawableSurface surface_;
};

Drawing drawing_of(const ViewerState& state, ViewSize size) {
    const SurfaceShape shape = state.shape();
    HostFrame frame(state, shape);
    if (!state.model() || state.settings.source == ShownCurvature::estimated) return frame.draw_measured(state, size);
    if (!state.shows_both()) return frame.draw_learned(state, shape, size);
    const ViewSize left{std::max(size.width / 2, 1), size.height};
    const ViewSize right{std::max(size.width - left.width, 1), size.height};
    const Drawing learned = frame.draw_learned(state, shape, left);
    return side_by_side(learned, frame.draw_measured(state, right));
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
