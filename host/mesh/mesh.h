#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace exemplar {

using Vec2 = Eigen::Vector2f;
using Vec3 = Eigen::Vector3f;
using Vec3d = Eigen::Vector3d;

/// Three vertex indices, counter-clockwise seen from outside.
using Face = std::array<std::uint32_t, 3>;

/// An indexed triangle mesh. Faces refer to existing vertices; nothing else is promised (see validate_mesh).
struct TriangleMesh {
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    /// For each triangle the polygon of the file that it was cut from; empty if the file held only triangles.
    std::vector<std::uint32_t> source_face;
    /// Number of polygons in the file; equals faces.size() if the file held only triangles.
    std::uint32_t source_face_count = 0;
    /// Added to `vertices`, gives the coordinates of the file. Zero, but for files whose position would take up the
    /// precision of floats, such as geographic ones (see mesh_io::origin_for_floats).
    Vec3d origin = Vec3d::Zero();

    std::size_t vertex_count() const { return vertices.size(); }
    std::size_t face_count() const { return faces.size(); }
    /// Returns the polygon of the file that triangle `face` belongs to.
    std::uint32_t source_of(std::uint32_t face) const { return source_face.empty() ? face : source_face[face]; }
};

struct BoundingBox {
    Vec3d low, high;
    double diagonal() const { return (high - low).norm(); }
};
/// Returns v / |v|, or +z if v is zero or not finite.
inline Vec3 unit_or_up(const Vec3d& v) {
    const double length = v.norm();
    if (!(length > 0) || !std::isfinite(length)) return Vec3::UnitZ();
    return (v / length).cast<float>();
}
/// Returns the box around all vertices that faces refer to; `low` is above `high` if there are no faces.
BoundingBox bounding_box(const TriangleMesh& mesh);

/// Returns the area of each face, in squared mesh units (zero for degenerate faces).
std::vector<float> face_areas(const TriangleMesh& mesh);
/// Returns the unit normal of each face. A degenerate face gets the area-weighted mean of its neighbors by vertex,
/// else +z.
std::vector<Vec3> face_normals(const TriangleMesh& mesh);
/// Returns the center (mean of the three corners) of each face.
std::vector<Vec3> face_centers(const TriangleMesh& mesh);
/// Returns the unit normal of each vertex, weighted as in Max 1999 (sine of the corner angle over edge lengths); +z
/// for unreferenced vertices.
std::vector<Vec3> vertex_normals(const TriangleMesh& mesh);
/// Returns the area-weighted mean of the face centers.
Vec3 area_centroid(const TriangleMesh& mesh);

}  // namespace exemplar
