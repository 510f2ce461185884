#include "apps/viewer/scene/surface_scene.h"

#include <algorithm>

#include "host/curvature/learning/training.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {
namespace {

float measured_feature_size(const Animation& animation) {
    const std::vector<Vec3> vertices = vertices_of(animation, shape_at(animation, 0, 0));
    CurvatureEstimator estimator(animation.rest.faces, vertices.size());
    CurvatureOptions options = measuring_options(nullptr);
    options.derivatives = false;
    return feature_size(vertices, estimator.estimate(vertices, options));
}

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

CurvatureOptions measuring_options(const CurvatureModel* model) {
    CurvatureOptions options = model ? model->truth : CurvatureTraining{}.truth;
    options.derivatives = true;
    options.robust = RobustEstimator::none;
    return options;
}

SurfaceScene::SurfaceScene(Device& device, const Document& document) : document_(document), device_(device) {
    renderer_ = std::make_unique<AnimationRenderer>(device, document.animation, measuring_options(nullptr));
}

void SurfaceScene::set_model(std::shared_ptr<const CurvatureModel> model) {
    if (!model && !model_) return;  // a document opens without one, and its renderer is made already
    if (model) require_compatible(*model, document_.animation);
    renderer_ =
        std::make_unique<AnimationRenderer>(device_, document_.animation, measuring_options(model.get()), model.get());
    colored_views_ = styled_views_ = 0;
    recorded_.reset();
    feature_size_ = model ? model->feature_size : 0;
    model_ = std::move(model);
}

void SurfaceScene::find_feature_size() {
    if (feature_size_ <= 0) feature_size_ = measured_feature_size(document_.animation);
}

void SurfaceScene::prepare_views(std::size_t count, const ViewSettings& settings) {
    if (style_version_ != settings.style_version) {
        style_ = device_style(settings.style);
        style_version_ = settings.style_version;
        styled_views_ = 0;
    }
    if (colors_version_ != document_.colors_version) {
        colors_version_ = document_.colors_version;
        colored_views_ = 0;
    }
    for (; !document_.face_colors.empty() && colored_views_ < count; ++colored_views_)
        renderer_->view(colored_views_).set_face_colors(document_.face_colors);
    for (; styled_views_ < count; ++styled_views_) renderer_->view(styled_views_).set_textures(style_.textures);
}

LinePicture SurfaceScene::picture_of(const OrbitCamera& camera, VkExtent2D extent, const ViewSettings& settings) const {
    const ViewSize size{static_cast<int>(extent.width), static_cast<int>(extent.height)};
    LinePicture picture;
    apply_style(style_, settings.shown_lines(), picture);
    picture.surface = look_of(settings, feature_size_);
    picture.view = {.camera = camera.camera(size),
                    .width = size.width,
                    .height = size.height,
                    .unit_depth = camera.distance(),
                    .feature_size = feature_size_};
    return picture;
}

bool SurfaceScene::same(const Recorded& a, const Recorded& b) {
    return a.source == b.source && a.cut == b.cut && a.shape.vertices.data() == b.shape.vertices.data() &&
           a.shape.vertices.size() == b.shape.vertices.size() && a.shape.pose == b.shape.pose;
}

void SurfaceScene::record(Stream& stream, const SurfaceShape& shape, const OrbitCamera& camera,
                          std::span<const VkExtent2D> extents, const ViewSettings& settings) {
    const bool curved = settings.needs_curvature();
    const bool learned = model_ && settings.source != ShownCurvature::estimated;
    if (curved) find_feature_size();
    const Recorded wanted{.shape = shape,
                          .source = !curved   ? CurvatureSource::none
                                    : learned ? CurvatureSource::learned
                                              : CurvatureSource::estimated,
                          .cut = settings.shows(LineType::creases)};
    if (!recorded_ || !same(*recorded_, wanted)) {
        recorded_.reset();
        renderer_->set_cut_curvature(wanted.cut);
        renderer_->record(stream, shape, wanted.source);
        if (extents.size() == 1) recorded_ = wanted;  // the second view has another curvature
    }
    prepare_views(extents.size(), settings);
    for (std::size_t i = 0; i < extents.size(); ++i) {
        if (i > 0) renderer_->record_again(stream, CurvatureSource::estimated);
        renderer_->view(i).record(stream, renderer_->snapshot(), picture_of(camera, extents[i], settings));
    }
}

}  // namespace exemplar
