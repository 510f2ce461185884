// Moved or reordered vertices.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/synth/damage/damage_kinds.h"

namespace exemplar {
namespace {

/// Returns the mean length of the edges at each vertex; 0 where there are none.
std::vector<double> mean_edge_lengths(const TriangleMesh& mesh) {
    std::vector<double> sum(mesh.vertex_count(), 0), count(mesh.vertex_count(), 0);
    for (const Face& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = face[k], b = face[(k + 1) % 3];
            const double length = (mesh.vertices[a].cast<double>() - mesh.vertices[b].cast<double>()).norm();
            for (const std::uint32_t v : {a, b}) sum[v] += length, count[v] += 1;
        }
    for (std::size_t v = 0; v < sum.size(); ++v)
        if (count[v] > 0) sum[v] /= count[v];
    return sum;
}

/// Moves vertices in random directions. The root-mean-square distance is a share of the diagonal, but at most a
/// share of the mean length of the edges around: on fine meshes, noise of the former size would destroy the surface.
DamagedMesh with_noise(const TriangleMesh& mesh, std::uint64_t seed, double of_diagonal, double of_edges) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const double diagonal = bounding_box(mesh).diagonal();
    const std::vector<double> edge = mean_edge_lengths(mesh);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
        const double deviation = std::min(of_diagonal * diagonal, of_edges * edge[v]) / std::sqrt(3.0);  // per axis
        for (float& x : damaged.mesh.vertices[v]) x += static_cast<float>(deviation * random.normal());
    }
    return damaged;
}

DamagedMesh scaled(const TriangleMesh& mesh, float factor) {
    DamagedMesh damaged = undamaged(mesh);
    for (Vec3& v : damaged.mesh.vertices) v *= factor;
    return damaged;
}

std::vector<std::uint32_t> random_order(std::size_t count, Random& random) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    random.shuffle(order);
    return order;
}

}  // namespace

DamagedMesh add_noise(const TriangleMesh& mesh, std::uint64_t seed) {
    return with_noise(mesh, seed, 0.005, 0.10);
}

DamagedMesh add_strong_noise(const TriangleMesh& mesh, std::uint64_t seed) {
    return with_noise(mesh, seed, 0.01, 0.25);
}

DamagedMesh rotate(const TriangleMesh& mesh, std::uint64_t seed) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    Eigen::Vector4d quaternion;  // normal deviates have no preferred direction: all rotations are equally likely
    do {
        for (double& x : quaternion) x = random.normal();
    } while (quaternion.norm() < 1e-6);
    const Eigen::Matrix3d rotation = Eigen::Quaterniond(quaternion.normalized()).toRotationMatrix();
    for (Vec3& v : damaged.mesh.vertices) v = (rotation * v.cast<double>()).cast<float>();
    return damaged;
}

DamagedMesh scale_down(const TriangleMesh& mesh, std::uint64_t) {
    return scaled(mesh, 1e-6F);
}

DamagedMesh scale_up(const TriangleMesh& mesh, std::uint64_t) {
    return scaled(mesh, 1e6F);
}

DamagedMesh move_far(const TriangleMesh& mesh, std::uint64_t seed) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const Vec3d offset = 100 * bounding_box(mesh).diagonal() * random_direction(random);
    for (Vec3& v : damaged.mesh.vertices) v = (v.cast<double>() + offset).cast<float>();
    return damaged;
}

DamagedMesh add_loose_vertices(const TriangleMesh& mesh, std::uint64_t seed) {
    constexpr std::uint32_t k_loose = 100;
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const double diagonal = bounding_box(mesh).diagonal();
    const Vec3d center = area_centroid(mesh).cast<double>();
    std::vector<Vec3> loose;  // inserted before the others, so that their numbers change
    for (std::uint32_t i = 0; i < k_loose; ++i)
        loose.emplace_back((center + random.uniform(0, 10) * diagonal * random_direction(random)).cast<float>());
    damaged.mesh.vertices.insert(damaged.mesh.vertices.begin(), loose.begin(), loose.end());
    for (Face& face : damaged.mesh.faces)
        for (std::uint32_t& v : face) v += k_loose;
    return damaged;
}

DamagedMesh shuffle_order(const TriangleMesh& mesh, std::uint64_t seed) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const std::vector<std::uint32_t> place = random_order(mesh.vertex_count(), random);
    for (std::size_t v = 0; v < place.size(); ++v) damaged.mesh.vertices[place[v]] = mesh.vertices[v];
    damaged.origin = random_order(mesh.face_count(), random);
    for (std::size_t f = 0; f < damaged.origin.size(); ++f) {
        const Face& face = mesh.faces[damaged.origin[f]];
        const std::size_t first = random.index(3);
        for (std::size_t k = 0; k < 3; ++k) damaged.mesh.faces[f][k] = place[face[(first + k) % 3]];
    }
    return damaged;
}

}  // namespace exemplar
