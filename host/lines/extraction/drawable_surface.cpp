#include "host/lines/extraction/drawable_surface.h"

#include "host/lines/extraction/cut_surface.h"

namespace exemplar {

DrawableSurface::DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first,
                                 const DrawableOptions& options)
    : faces_(faces), options_(options), neighbors_(build_face_neighbors(faces, first)) {
    mark_sharp_edges(faces, first, options.crease_angle, neighbors_);
    if (!options.cut) return;
    split_ = split_at_sharp_edges(faces, first.size(), neighbors_);
    cut_.faces = split_->faces;
    if (split_->source.size() == first.size()) split_.reset();  // nothing is cut
}

void DrawableSurface::measure(std::span<const Vec3> vertices) {
    vertices_ = vertices;
    if (split_) cut_.vertices = split_->positions(vertices);
    const bool cut = split_ && options_.cut_curvature;
    const std::span<const Vec3> at = cut ? std::span<const Vec3>(cut_.vertices) : vertices;
    if (!estimator_) estimator_.emplace(cut ? std::span<const Face>(cut_.faces) : faces_, at.size());
    if (smoothing_unit_ == 0) smoothing_unit_ = estimator_->median_edge_length(at);
    CurvatureOptions options;
    options.derivatives = options_.derivatives;
    options.smoothing = smoothing_unit_ > 0 ? options_.smoothing : 0;
    options.smoothing_unit = smoothing_unit_;
    curvature_ = &estimator_->estimate(at, options);
    if (!split_ || cut) return;
    cut_normals_ = vertex_normals(cut_);
    cut_curvature_ = curvature_after_cut(*curvature_, split_->source);
}

LineSurface DrawableSurface::surface() const {
    if (!split_) return {faces_, vertices_, estimator_->normals(), *curvature_, neighbors_};
    if (options_.cut_curvature)
        return {cut_.faces, cut_.vertices, estimator_->normals(), *curvature_, neighbors_, faces_};
    return {cut_.faces, cut_.vertices, cut_normals_, cut_curvature_, neighbors_, faces_};
}

float DrawableSurface::feature_size() const {
    const bool cut = split_ && options_.cut_curvature;
    return exemplar::feature_size(cut ? std::span<const Vec3>(cut_.vertices) : vertices_, *curvature_);
}

}  // namespace exemplar
