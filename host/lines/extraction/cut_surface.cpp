#include "host/lines/extraction/cut_surface.h"

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

}  // namespace

VertexCurvature curvature_after_cut(const VertexCurvature& curvature, std::span<const std::uint32_t> source) {
    return {gathered(curvature.k1, source), gathered(curvature.k2, source), gathered(curvature.e1, source),
            gathered(curvature.e2, source), gathered(curvature.derivative, source)};
}

CutSurface::CutSurface(std::span<const Face> faces, std::span<const Vec3> vertices, std::span<const Vec3> normals,
                       const VertexCurvature& curvature, float crease_angle)
    : faces_(faces),
      vertices_(vertices),
      normals_(normals),
      curvature_(curvature),
      neighbors_(build_face_neighbors(faces, vertices)) {
    mark_sharp_edges(faces, vertices, crease_angle, neighbors_);
    split_ = split_at_sharp_edges(faces, vertices.size(), neighbors_);
    const std::vector<std::uint32_t>& source = split_->source;
    if (source.size() == vertices.size()) {
        split_.reset();  // nothing is cut
        return;
    }
    cut_.vertices = split_->positions(vertices);
    cut_.faces = split_->faces;
    cut_normals_ = vertex_normals(cut_);
    cut_curvature_ = curvature_after_cut(curvature, source);
}

LineSurface CutSurface::surface() const {
    if (!split_) return {faces_, vertices_, normals_, curvature_, neighbors_};
    return {cut_.faces, cut_.vertices, cut_normals_, cut_curvature_, neighbors_, faces_};
}

}  // namespace exemplar
