#include "apps/viewer/scene/surface_scene.h"

#include <algorithm>

#include "host/curvature/state/samples.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {
namespace {

// Default of training, used without a model; see CurvatureTraining.
constexpr CurvatureOptions k_measured{.derivatives = true, .smoothing = 1};

float measured_feature_size(const Document& document) {
    const std::vector<Vec3> vertices = vertices_at(document, frame_shape_of(document, 0, 0));
    CurvatureEstimator estimator(document.animation.rest.faces, vertices.size());
    CurvatureOptions options = k_measured;
    options.derivatives = false;
    return feature_size(vertices, estimator.estimate(vertices, options));
}

}  // namespace

FrameShape frame_shape_of(const Document& document, std::size_t clip, std::size_t frame) {
    const Animation& animation = document.animation;
    const bool exists = clip < animation.clips.size() && frame < animation.clips[clip].size();
    if (document.posable()) return {exists ? animation.clips[clip].poses[frame] : rest_pose(animation.rig)};
    if (!exists) return {.pose = {}, .vertices = animation.rest.vertices};
    return {.pose = {}, .vertices = animation.clips[clip].frames[frame]};
}

std::vector<Vec3> vertices_at(const Document& document, const FrameShape& snapshot) {
    const Animation& animation = document.animation;
    if (!snapshot.pose) return {snapshot.vertices.begin(), snapshot.vertices.end()};
    std::vector<Vec3> vertices;
    pose_vertices(animation.rig, animation.rest.vertices, *snapshot.pose, vertices);
    return vertices;
}

SurfaceScene::SurfaceScene(Device& device, const Document& document)
    : document_(document), surface_(device, first_shape(document.animation)), line_surface_(surface_) {
    animated_.emplace(surface_, document.animation, k_measured);
}

// Measures curvature as in the model's training, so that both can be compared.
void SurfaceScene::set_model(std::shared_ptr<const CurvatureModel> model) {
    CurvatureOptions options = model ? model->truth : k_measured;
    options.derivatives = true;
    options.robust = RobustEstimator::none;  // which the device does not have
    if (model) require_compatible(*model, document_.animation);
    animated_.emplace(surface_, document_.animation, options);
    if (model) animated_->set_model(*model);
    feature_size_ = model ? model->feature_size : 0;
    model_ = std::move(model);
}

void SurfaceScene::find_feature_size() {
    if (feature_size_ <= 0) feature_size_ = measured_feature_size(document_);
}

void SurfaceScene::record_moment(Stream& stream, const FrameShape& snapshot, CurvatureSource source) {
    if (snapshot.pose)
        animated_->record(stream, *snapshot.pose, source);
    else
        animated_->record(stream, snapshot.vertices, source);
}

void SurfaceScene::record(Stream& stream, const FrameShape& snapshot, const OrbitCamera& camera,
                          std::span<const VkExtent2D> extents, const ViewSettings& settings) {
    const bool curved = settings.needs_curvature();
    const bool learned = has_model() && settings.source != ShownCurvature::estimated;
    if (curved) find_feature_size();
    record_moment(stream, snapshot,
                  !curved   ? CurvatureSource::none
                  : learned ? CurvatureSource::learned
                            : CurvatureSource::estimated);
    while (views_.size() < extents.size()) views_.emplace_back(line_surface_, document_.face_colors);
    for (std::size_t i = 0; i < extents.size(); ++i) {
        if (i > 0) animated_->record_again(stream, CurvatureSource::estimated);
        const ViewSize size{static_cast<int>(extents[i].width), static_cast<int>(extents[i].height)};
        views_[i].record(stream, {.surface = animated_->snapshot(), .feature_size = feature_size_},
                         {camera.camera(size), camera.distance()}, extents[i], settings);
    }
}

}  // namespace exemplar
