#include "host/parts/materials/part_projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/mesh/queries/axes.h"

namespace exemplar {
namespace {

constexpr float k_flat_share = 0.2F;

PrincipalAxes axes_of_faces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces) {
    TriangleMesh part;
    part.vertices = mesh.vertices;
    part.faces.reserve(faces.size());
    for (const std::uint32_t f : faces) part.faces.push_back(mesh.faces[f]);
    part.source_face_count = static_cast<std::uint32_t>(part.faces.size());
    return principal_axes(part);
}

/// A cylinder around a part: u runs around it from the seam, v along it.
class PartCylinder {
  public:
    PartCylinder(const PrincipalAxes& axes, const Vec3& center, float size) : axes_(axes), size_(size) {
        Vec3 seam = center - axes.center;
        seam -= seam.dot(axes.axis[0]) * axes.axis[0];
        if (seam.norm() < 1e-3F * axes.sigma[0]) seam = axes.axis[1];  // the part is around the center
        across_ = -seam.normalized();
        side_ = axes.axis[0].cross(across_);
        const float radius = std::hypot(axes.sigma[1], axes.sigma[2]);
        turns_ = std::max(1.0F, std::round(2 * std::numbers::pi_v<float> * radius / size));
    }

    Vec2 uv(const Vec3& position) const {
        const Vec3 p = position - axes_.center;
        const float angle = std::atan2(p.dot(side_), p.dot(across_));
        return {turns_ * (angle / (2 * std::numbers::pi_v<float>)+0.5F), p.dot(axes_.axis[0]) / size_};
    }

    /// Moves the corners of a face that the seam divides to one side of it.
    void join(CornerUv& corners) const {
        const auto [low, high] = std::minmax_element(corners.begin(), corners.end(),
                                                     [](const Vec2& a, const Vec2& b) { return a[0] < b[0]; });
        if ((*high)[0] - (*low)[0] <= turns_ / 2) return;
        for (Vec2& corner : corners)
            if (corner[0] < turns_ / 2) corner[0] += turns_;
    }

  private:
    PrincipalAxes axes_;
    float size_, turns_;
    Vec3 across_, side_;
};

}  // namespace

std::vector<CornerUv> project_part(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces,
                                   const Vec3& center, float size) {
    const PrincipalAxes axes = axes_of_faces(mesh, faces);
    const bool is_flat = axes.sigma[2] < k_flat_share * axes.sigma[1];
    const PartCylinder cylinder(axes, center, size);
    std::vector<CornerUv> result(faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& position = mesh.vertices[mesh.faces[faces[i]][k]];
            const Vec3 p = position - axes.center;
            result[i][k] =
                is_flat ? Vec2(p.dot(axes.axis[0]) / size, p.dot(axes.axis[1]) / size) : cylinder.uv(position);
        }
        if (!is_flat) cylinder.join(result[i]);
    }
    return result;
}

}  // namespace exemplar
