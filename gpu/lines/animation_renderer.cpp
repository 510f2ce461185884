#include "gpu/lines/animation_renderer.h"

namespace exemplar {

AnimationRenderer::AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                                     const CurvatureModel* model, float crease_angle, bool cut)
    : animation_(animation),
      cut_(animation, first_shape(animation), crease_angle, cut && model == nullptr),
      surface_(device, cut_.first()),
      line_surface_(surface_, cut_.neighbors(), cut_.joined_faces()),
      moving_(surface_, cut_.animation(), estimated) {
    if (model) moving_.set_model(*model);
}

void AnimationRenderer::record(Stream& stream, FrameRef frame, CurvatureSource source) {
    record(stream, shape_at(animation_, frame.clip, frame.frame), source);
}

LineRenderer& AnimationRenderer::view(std::size_t index) {
    while (views_.size() <= index) views_.emplace_back(surface_.device(), line_surface_);
    return views_[index];
}

}  // namespace exemplar
