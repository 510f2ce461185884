#include "host/lines/extraction/drawable_surface.h"

namespace exemplar {

namespace {

template <typename T>
std::vector<T> gathered(const std::vector<T>& values, std::span<const std::uint32_t> source) {
    std::vector<T> result;
    if (values.empty()) return result;
    result.reserve(source.size());
    for (const std::uint32_t v : source) result.push_back(values[v]);
    return result;
}

// Returns the curvature of the vertices of a cut surface, each that of the one it was cut from (SplitSurface::source).
VertexCurvature after_cut(const VertexCurvature& curvature, std::span<const std::uint32_t> source) {
    return {gathered(curvature.k1, source), gathered(curvature.k2, source), gathered(curvature.e1, source),
            gathered(curvature.e2, source), gathered(curvature.derivative, source)};
}

}  // namespace

DrawableSurface::DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first,
                                 const DrawableOptions& options)
    : faces_(faces), options_(options), edges_(find_sharp_edges(faces, first, options.crease_angle)) {
    if (edges_.split) cut_.faces = edges_.split->faces;
}

void DrawableSurface::measure(std::span<const Vec3> vertices) {
    std::span<const Vec3> measured = vertices;
    if (measures_parts()) {
        cut_.vertices = edges_.split->positions(vertices);
        measured = cut_.vertices;
    }
    if (!estimator_) estimator_.emplace(measures_parts() ? std::span<const Face>(cut_.faces) : faces_, measured.size());
    CurvatureOptions& options = options_.curvature;
    if (options.smoothing_unit == 0) options.smoothing_unit = estimator_->median_edge_length(measured);
    if (options.smoothing_unit == 0) options.smoothing = 0;  // all vertices are at one place
    measured_ = &estimator_->estimate(measured, options);
    if (!measures_parts()) return take(vertices, estimator_->normals(), *measured_);
    vertices_ = measured;
    normals_ = estimator_->normals();
    curvature_ = measured_;
}

void DrawableSurface::take(std::span<const Vec3> vertices, std::span<const Vec3> normals,
                           const VertexCurvature& curvature) {
    vertices_ = vertices;
    normals_ = normals;
    curvature_ = &curvature;
    if (!edges_.split) return;
    cut_.vertices = edges_.split->positions(vertices);
    cut_normals_ = vertex_normals(cut_);
    cut_curvature_ = after_cut(curvature, edges_.split->source);
    vertices_ = cut_.vertices;
    normals_ = cut_normals_;
    curvature_ = &cut_curvature_;
}

LineSurface DrawableSurface::surface() const {
    if (!edges_.split) return {faces_, vertices_, normals_, *curvature_, edges_.neighbors};
    return {cut_.faces, vertices_, normals_, *curvature_, edges_.neighbors, faces_};
}

float DrawableSurface::feature_size() const {
    // The vertices that were measured: of the cut surface all of them, or the first ones, which are those of the whole
    // surface.
    const std::size_t count = measured_->k1.size();
    return exemplar::feature_size(vertices_.first(count), *measured_);
}

}  // namespace exemplar
