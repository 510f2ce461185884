#include "apps/viewer/scene/scene_view.h"

#include <algorithm>

namespace exemplar {
namespace {

PaintLook look_of(const ViewSettings& settings, float feature_size) {
    PaintLook look{.paint = settings.paint,
                   .light = settings.light,
                   .plain = settings.plain,
                   .full_color_curvature = settings.curvature_range / std::max(feature_size, 1e-20f),
                   .background = settings.background};
    // Under lines the surface has the headlight, as in styles, so that lines stand out.
    if (look.light == SurfaceLight::smooth && settings.shows_lines()) look.light = SurfaceLight::headlight;
    return look;
}

}  // namespace

SceneView::SceneView(const GpuLineSurface& surface, std::span<const Color> colors)
    : renderer_(surface.surface().device(), surface) {
    if (!colors.empty()) renderer_.set_face_colors(colors);
}

void SceneView::follow_style(const ViewSettings& settings) {
    if (style_version_ == settings.style_version) return;
    style_ = device_style(settings.style);
    renderer_.set_textures(style_.textures);
    style_version_ = settings.style_version;
}

void SceneView::record(Stream& stream, const SceneFrame& moment, const ViewCamera& camera, VkExtent2D extent,
                       const ViewSettings& settings) {
    follow_style(settings);
    LinePicture picture;
    apply_style(style_, settings.shown_lines(), picture);
    picture.surface = look_of(settings, moment.feature_size);
    picture.view = {.camera = camera.camera,
                    .width = static_cast<int>(extent.width),
                    .height = static_cast<int>(extent.height),
                    .unit_depth = camera.distance,
                    .feature_size = moment.feature_size};
    renderer_.record(stream, moment.surface, picture);
}

}  // namespace exemplar
