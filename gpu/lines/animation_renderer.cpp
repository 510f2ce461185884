#include "gpu/lines/animation_renderer.h"

namespace exemplar {

AnimationRenderer::AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                                     const CurvatureModel* model)
    : animation_(animation), surface_(device, first_shape(animation)), line_surface_(surface_) {
    set_curvature(estimated, model);
}

void AnimationRenderer::set_curvature(const CurvatureOptions& estimated, const CurvatureModel* model) {
    moving_.emplace(surface_, animation_, estimated);
    if (model) moving_->set_model(*model);
}

void AnimationRenderer::record(Stream& stream, FrameRef frame, CurvatureSource source) {
    record(stream, shape_at(animation_, frame.clip, frame.frame), source);
}

void AnimationRenderer::record(Stream& stream, const SurfaceShape& shape, CurvatureSource source) {
    moving_->record(stream, shape, source);
}

LineRenderer& AnimationRenderer::view(std::size_t index) {
    while (views_.size() <= index) views_.emplace_back(surface_.device(), line_surface_);
    return views_[index];
}

}  // namespace exemplar
