#include "gpu/imaging/surface_painter.h"

#include <utility>
#include <vector>

#include "embedded/imaging_surface_frag.h"
#include "embedded/imaging_surface_vert.h"
#include "embedded/imaging_unlit_frag.h"
#include "embedded/imaging_unlit_vert.h"
#include "gpu/imaging/picture.h"
#include "gpu/runtime/device/device.h"

namespace exemplar {
namespace {

// Returns the wanted paint, or plain if the surface lacks its buffers.
SurfacePaint paint_of(const PaintedSurface& surface, SurfacePaint wanted) {
    const bool possible = wanted == SurfacePaint::faces ? surface.colors != nullptr
                          : paints_curvature(wanted)    ? surface.first && surface.second
                                                        : true;
    return possible ? wanted : SurfacePaint::plain;
}

// Returns whether a variant is plain paint without light, which has shaders of its own.
bool is_unlit(const std::array<std::uint32_t, 3>& variant) {
    return variant[0] == shared::k_paint_plain && variant[1] == shared::k_light_none;
}

shared::PaintParameters paint_parameters(const Camera& camera, SurfacePaint paint, const PaintLook& look) {
    const auto [red, green, blue, opaque] = clear_value(look.plain);
    const bool hides_only = paint == SurfacePaint::plain && look.transparent && look.transparent_plain;
    shared::PaintParameters parameters{.matrix = {},
                                       .eye = homogeneous_eye(camera),
                                       .plain = {red, green, blue, hides_only ? 0 : opaque},
                                       .curvature_scale = 1 / look.full_color_curvature,
                                       .unused0 = 0,
                                       .unused1 = 0,
                                       .unused2 = 0};
    put_matrix(camera.view_projection(), parameters.matrix);
    return parameters;
}

}  // namespace

bool paints_curvature(SurfacePaint paint) {
    return paint >= SurfacePaint::mean_curvature && paint <= SurfacePaint::second_curvature;
}

std::array<float, 4> background_of(const PaintLook& look) {
    return look.transparent ? std::array<float, 4>{} : clear_value(look.background);
}

const DrawPipeline& SurfacePainter::pipeline(const Variant& variant) {
    DrawPipeline& result = pipelines_[variant];
    if (result) return result;
    const bool unlit = is_unlit(variant);
    const StructLayout four = layout_of<shared::vec4>(), words = layout_of<shared::uvec4>();
    std::vector<StructLayout> elements{four, words};
    if (!unlit) elements.insert(elements.end(), {four, layout_of<std::uint32_t>(), four, four});
    result = DrawPipeline(device_, unlit ? shaders::imaging_unlit_vert : shaders::imaging_surface_vert,
                          unlit ? shaders::imaging_unlit_frag : shaders::imaging_surface_frag,
                          {.push_constants = layout_of<shared::PaintParameters>(),
                           .elements = std::move(elements),
                           .constants = {{0, variant[0]}, {1, variant[1]}, {2, variant[2]}}},
                          {.color = color_, .depth = depth_});
    return result;
}

void SurfacePainter::draw(Pass& pass, const PaintedSurface& surface, const Camera& camera, const PaintLook& look) {
    const SurfacePaint paint = paint_of(surface, look.paint);
    // With colors per face, vertices cannot be shared between faces.
    const bool by_corner = paint == SurfacePaint::faces || !surface.indices;
    const Variant variant{static_cast<std::uint32_t>(paint), static_cast<std::uint32_t>(look.light), by_corner};
    const Draw what{.vertices = 3 * surface.face_count, .indices = by_corner ? nullptr : surface.indices};
    const shared::PaintParameters parameters = paint_parameters(camera, paint, look);
    if (is_unlit(variant)) {
        pass.draw(pipeline(variant), what, {*surface.vertices, *surface.faces}, parameters);
        return;
    }
    // Buffers that the look does not read must be bound nevertheless.
    const Buffer& colors = surface.colors ? *surface.colors : *surface.faces;
    const Buffer& first = surface.first ? *surface.first : *surface.vertices;
    const Buffer& second = surface.second ? *surface.second : *surface.vertices;
    pass.draw(pipeline(variant), what, {*surface.vertices, *surface.faces, *surface.normals, colors, first, second},
              parameters);
}

}  // namespace exemplar
