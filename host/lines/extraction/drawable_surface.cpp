#include "host/lines/extraction/drawable_surface.h"

namespace exemplar {

DrawableSurface::DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first,
                                 const DrawableOptions& options)
    : faces_(faces), options_(options), neighbors_(build_face_neighbors(faces, first)) {
    mark_sharp_edges(faces, first, options.crease_angle, neighbors_);
    if (!options.cut) return;
    split_ = split_at_sharp_edges(faces, first.size(), neighbors_);
    if (split_->source.size() == first.size()) split_.reset();  // nothing is cut
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
}

LineSurface DrawableSurface::surface() const {
    if (!split_) return {faces_, vertices_, estimator_->normals(), *curvature_, neighbors_};
    return {split_->faces, split_vertices_, estimator_->normals(), *curvature_, neighbors_, faces_};
}

}  // namespace exemplar
