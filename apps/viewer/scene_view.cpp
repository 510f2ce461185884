#include "apps/viewer/scene_view.h"

#include <algorithm>

#include "gpu/imaging/picture.h"

namespace exemplar {
namespace {

SurfaceLook look_of(const ViewSettings& settings, bool has_colors) {
    SurfaceLook look;
    look.background = settings.background;
    look.paper = settings.plain;
    look.transparent_paper = false;
    if (settings.light == SurfaceLight::smooth || settings.light == SurfaceLight::flat)
        look.shading = SurfaceLook::Shading::smooth;
    if (settings.light == SurfaceLight::steps) look.shading = SurfaceLook::Shading::steps;
    if (settings.paint == SurfacePaint::faces && has_colors) look.coloring = SurfaceLook::Coloring::faces;
    if (settings.paint == SurfacePaint::mean_curvature) look.coloring = SurfaceLook::Coloring::curvature;
    return look;
}

}  // namespace

SceneView::SceneView(const GpuSurface& surface, const GpuLineSurface& lines, std::span<const Color> colors)
    : surface_(surface), line_surface_(lines), colors_(colors.begin(), colors.end()), picture_(surface.device()) {}

void SceneView::record(Stream& stream, const SceneMoment& moment, const ViewCamera& camera, VkExtent2D extent,
                       const ViewSettings& settings) {
    with_lines_ = settings.shows_lines();
    if (with_lines_)
        record_lines(stream, moment, camera, extent, settings);
    else
        record_surface(stream, moment, camera, extent, settings);
}

void SceneView::follow_style(const ViewSettings& settings) {
    if (style_version_ == settings.style_version) return;
    style_ = device_style(settings.style);
    lines_->set_textures(style_.textures);
    style_version_ = settings.style_version;
}

void SceneView::record_lines(Stream& stream, const SceneMoment& moment, const ViewCamera& camera, VkExtent2D extent,
                             const ViewSettings& settings) {
    if (!lines_) {
        lines_.emplace(surface_.device(), line_surface_);
        if (!colors_.empty()) lines_->set_face_colors(colors_);
    }
    follow_style(settings);
    LinePicture picture;
    apply_style(style_, settings.shown_lines(), picture);
    picture.surface = look_of(settings, !colors_.empty());
    picture.view = {.camera = camera.camera,
                    .width = static_cast<int>(extent.width),
                    .height = static_cast<int>(extent.height),
                    .unit_depth = camera.distance,
                    .feature_size = moment.feature_size};
    lines_->record(stream, moment.surface, picture);
}

void SceneView::record_surface(Stream& stream, const SceneMoment& moment, const ViewCamera& camera, VkExtent2D extent,
                               const ViewSettings& settings) {
    if (!painter_) painter_.emplace(surface_.device(), Canvas::k_rgba, picture_.depth_format());
    PaintLook look{.paint = settings.paint,
                   .light = settings.light,
                   .plain = settings.plain,
                   .strongest_curvature = settings.curvature_range / std::max(moment.feature_size, 1e-20f)};
    if (look.paint == SurfacePaint::faces && colors_.empty()) look.paint = SurfacePaint::plain;
    picture_.resize(extent);
    picture_.begin(stream);
    Pass pass("surface", picture_.cleared(clear_value(settings.background)));
    painter_->draw(pass,
                   {.face_count = surface_.face_count(),
                    .faces = &surface_.faces(),
                    .vertices = &moment.surface.vertices,
                    .normals = &moment.surface.normals,
                    .colors = moment.face_colors,
                    .first = moment.surface.first,
                    .second = moment.surface.second},
                   camera.camera, look);
    stream.render(pass);
    picture_.end(stream);
}

}  // namespace exemplar
