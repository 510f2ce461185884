#include "host/mesh/queries/sliver_groups.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

namespace exemplar {
namespace {

struct Sliver {
    std::uint32_t face;
    /// Unit vector along the longest edge, of the two that whose largest component is positive, and the center in units
    /// of the mesh's size.
    Eigen::Matrix<float, 6, 1> place;
    Vec3 direction() const { return place.head<3>(); }
};

/// Returns v or -v, so that opposite vectors become equal.
Vec3 without_sign(const Vec3& v) {
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    return v[largest] < 0 ? Vec3(-v) : v;
}

std::vector<Sliver> find_slivers(const TriangleMesh& mesh) {
    constexpr float k_waste = 16;  // by how much the box must be larger
    std::vector<Sliver> slivers;
    const float size = std::max(static_cast<float>(bounding_box(mesh).diagonal()), 1e-30F);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const auto& [i, j, k] = mesh.faces[f];
        const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
        const Vec3 box = a.cwiseMax(b).cwiseMax(c) - a.cwiseMin(b).cwiseMin(c);
        const float half_box = box.x() * box.y() + box.y() * box.z() + box.z() * box.x();
        if (!(half_box > k_waste * (b - a).cross(c - a).norm())) continue;
        Vec3 longest = b - a;
        for (const Vec3& edge : {Vec3(c - b), Vec3(a - c)})
            if (edge.squaredNorm() > longest.squaredNorm()) longest = edge;
        Sliver sliver{f, Eigen::Matrix<float, 6, 1>::Zero()};
        sliver.place << without_sign(longest.normalized()), (a + b + c) / (3 * size);
        slivers.push_back(sliver);
    }
    return slivers;
}

/// Returns the rotation into the frame of the mean direction and the main normal across it.
Eigen::Matrix3f group_rotation(const TriangleMesh& mesh, std::span<const Sliver> group) {
    Vec3 along = Vec3::Zero();
    Eigen::Matrix3f normals = Eigen::Matrix3f::Zero();  // sum of n n^T: the sign of n does not matter
    for (const Sliver& sliver : group) {
        const auto& [i, j, k] = mesh.faces[sliver.face];
        along += sliver.direction();
        const Vec3 normal =
            (mesh.vertices[j] - mesh.vertices[i]).cross(mesh.vertices[k] - mesh.vertices[i]).stableNormalized();
        normals += normal * normal.transpose();
    }
    Vec3 normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(normals).eigenvectors().col(2);
    along.normalize();
    normal -= normal.dot(along) * along;
    const Vec3 z = normal.norm() > 1e-3F ? Vec3(normal.normalized()) : along.unitOrthogonal();
    Eigen::Matrix3f rotation;
    rotation << along.transpose(), z.cross(along).transpose(), z.transpose();
    return rotation;
}

/// Halves the slivers by direction or place, by what differs most, until they are few or parallel.
void split_slivers(const TriangleMesh& mesh, std::span<Sliver> slivers, std::size_t max_size,
                   std::vector<SliverGroup>& groups) {
    constexpr float k_parallel = 1e-4F;
    Eigen::Matrix<float, 6, 1> low = slivers.front().place, high = low;
    for (const Sliver& sliver : slivers) {
        low = low.cwiseMin(sliver.place);
        high = high.cwiseMax(sliver.place);
    }
    Eigen::Index axis = 0;
    (high - low).maxCoeff(&axis);
    if ((high - low).head<3>().maxCoeff() < k_parallel || slivers.size() <= max_size) {
        SliverGroup group{group_rotation(mesh, slivers), {}};
        for (const Sliver& sliver : slivers) group.faces.push_back(sliver.face);
        std::ranges::sort(group.faces);
        groups.push_back(std::move(group));
        return;
    }
    const std::size_t half = slivers.size() / 2;
    std::nth_element(slivers.begin(), slivers.begin() + static_cast<std::ptrdiff_t>(half), slivers.end(),
                     [axis](const Sliver& a, const Sliver& b) {
                         return a.place[axis] != b.place[axis] ? a.place[axis] < b.place[axis] : a.face < b.face;
                     });
    split_slivers(mesh, slivers.first(half), max_size, groups);
    split_slivers(mesh, slivers.subspan(half), max_size, groups);
}

}  // namespace

std::vector<SliverGroup> group_slivers(const TriangleMesh& mesh, std::size_t min_slivers) {
    std::vector<Sliver> slivers = find_slivers(mesh);
    std::vector<SliverGroup> groups;
    if (slivers.empty() || slivers.size() < min_slivers) return groups;
    const auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(slivers.size())));
    split_slivers(mesh, slivers, std::max<std::size_t>(64, root), groups);
    return groups;
}

}  // namespace exemplar
