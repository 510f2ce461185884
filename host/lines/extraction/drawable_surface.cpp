#include "host/lines/extraction/drawable_surface.h"

namespace exemplar {

DrawableSurface::DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first,
                                 const DrawableOptions& options)
    : faces_(faces), options_(options), neighbors_(build_face_neighbors(faces, first.size())) {
    if (options.split_angle) split_ = split_at_creases(faces, first, neighbors_, *options.split_angle);
    if (split_ && split_->source.size() == first.size()) split_.reset();  // there are no creases
}

void DrawableSurface::measure(std::span<const Vec3> vertices) {
    vertices_ = vertices;
    if (split_) split_vertices_ = split_->positions(vertices);
    const std::span<const Vec3> at = split_ ? std::span<const Vec3>(split_vertices_) : vertices;
    if (!estimator_) estimator_.emplace(split_ ? std::span<const Face>(split_->faces) : faces_, at.size());
    if (smoothing_unit_ == 0) smoothing_unit_ = estimator_->median_edge_length(at);
    CurvatureOptions options;
    options.derivatives = options_.derivatives;
    options.smoothing = smoothing_unit_ > 0 ? options_.smoothing : 0;
    options.smoothing_unit = smoothing_unit_;
    curvature_ = &estimator_->estimate(at, options);
    if (!split_) return;
    no_normals_.assign(vertices.size(), Vec3::UnitZ());
    edges_.emplace(LineSurface{faces_, vertices_, no_normals_, no_curvature_, neighbors_});
}

LineSurface DrawableSurface::surface() const {
    if (!split_) return {faces_, vertices_, estimator_->normals(), *curvature_, neighbors_};
    return {split_->faces, split_vertices_, estimator_->normals(), *curvature_, neighbors_};
}

}  // namespace exemplar
