#include "gpu/window/surface_painter.h"

#include "embedded/window_surface_frag.h"
#include "embedded/window_surface_vert.h"
#include "gpu/runtime/device.h"

namespace exemplar {
namespace {

shared::PaintParameters parameters_of(const Camera& camera, const PaintLook& look) {
    const bool parallel = camera.projection(3, 3) != 0;
    const Vec3 eye = parallel ? camera.to_eye(Vec3::Zero()) : camera.position();
    const Eigen::Matrix4f matrix = camera.view_projection();
    shared::PaintParameters parameters{
        .matrix = {},
        .eye = {eye.x(), eye.y(), eye.z(), parallel ? 0.0f : 1.0f},
        .paint = static_cast<std::uint32_t>(look.paint),
        .light = static_cast<std::uint32_t>(look.light),
        .plain = look.plain[0] | std::uint32_t{look.plain[1]} << 8 | std::uint32_t{look.plain[2]} << 16,
        .curvature_scale = 1 / look.strongest_curvature};
    for (int column = 0; column < 4; ++column)
        parameters.matrix[column] = {matrix(0, column), matrix(1, column), matrix(2, column), matrix(3, column)};
    return parameters;
}

}  // namespace

bool paints_curvature(SurfacePaint paint) {
    return paint >= SurfacePaint::mean_curvature && paint <= SurfacePaint::second_curvature;
}

SurfacePainter::SurfacePainter(Device& device, VkFormat color, VkFormat depth)
    : pipeline_(device, shaders::window_surface_vert, shaders::window_surface_frag,
                {.push_constants = layout_of<shared::PaintParameters>(),
                 .elements = {layout_of<shared::uvec4>(), layout_of<shared::vec4>(), layout_of<shared::vec4>(),
                              layout_of<std::uint32_t>(), layout_of<shared::vec4>(), layout_of<shared::vec4>()}},
                {.color = color, .depth = depth}) {}

void SurfacePainter::draw(Pass& pass, const PaintedSurface& surface, const Camera& camera,
                          const PaintLook& look) const {
    // What the look does without is not read, but something must be bound.
    const Buffer& colors = surface.colors ? *surface.colors : *surface.faces;
    const Buffer& first = surface.first ? *surface.first : *surface.normals;
    const Buffer& second = surface.second ? *surface.second : *surface.normals;
    pass.draw(pipeline_, {.vertices = 3 * surface.face_count},
              {*surface.faces, *surface.vertices, *surface.normals, colors, first, second},
              parameters_of(camera, look));
}

}  // namespace exemplar
