#include "gpu/lines/animation_renderer.h"

#include <utility>

namespace exemplar {
namespace {

std::optional<GpuCutSurface> cut_open(const GpuSurface& surface, const SharpEdges& edges,
                                      const CurvatureOptions& options) {
    if (!edges.split) return std::nullopt;
    return std::optional<GpuCutSurface>(std::in_place, surface, *edges.split, options);
}

}  // namespace

AnimationRenderer::AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                                     const CurvatureModel* model, float crease_angle)
    : AnimationRenderer(device, animation, estimated, model, first_shape_of(animation, crease_angle)) {}

AnimationRenderer::AnimationRenderer(Device& device, const Animation& animation, const CurvatureOptions& estimated,
                                     const CurvatureModel* model, const FirstShape& first)
    : animation_(animation),
      surface_(device, first.mesh),
      cut_(cut_open(surface_, first.edges, estimated)),
      line_surface_(cut_ ? cut_->surface() : surface_, first.edges.neighbors, surface_.rest().faces),
      moving_(surface_, animation, estimated) {
    if (model) moving_.set_model(*model);
}

AnimationRenderer::FirstShape AnimationRenderer::first_shape_of(const Animation& animation, float crease_angle) {
    TriangleMesh mesh = first_shape(animation);
    SharpEdges edges = find_sharp_edges(mesh.faces, mesh.vertices, crease_angle);
    return {std::move(mesh), std::move(edges)};
}

void AnimationRenderer::record(Stream& stream, FrameRef frame, CurvatureSource source) {
    record(stream, shape_at(animation_, frame.clip, frame.frame), source);
}

void AnimationRenderer::record(Stream& stream, const SurfaceShape& shape, CurvatureSource source) {
    moving_.record(stream, shape, estimates_parts(source) ? CurvatureSource::none : source);
    record_cut(stream, source);
}

void AnimationRenderer::record_again(Stream& stream, CurvatureSource source) {
    if (!estimates_parts(source)) moving_.record_again(stream, source);
    record_cut(stream, source);
}

void AnimationRenderer::record_cut(Stream& stream, CurvatureSource source) {
    if (estimates_parts(source))
        cut_->record_parts(stream, moving_.snapshot());
    else if (cut_)
        cut_->record(stream, moving_.snapshot());
}

LineRenderer& AnimationRenderer::view(std::size_t index) {
    while (views_.size() <= index) views_.emplace_back(surface_.device(), line_surface_);
    return views_[index];
}

}  // namespace exemplar
