#include "host/mesh/mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace exemplar {

namespace {

/// Returns twice the area times the normal of a face, in double: the products of float coordinates then neither
/// cancel nor underflow, so only truly degenerate faces give zero.
Vec3d area_vector(const TriangleMesh& mesh, const Face& face) {
    const Vec3d a = mesh.vertices[face[0]].cast<double>();
    return (mesh.vertices[face[1]].cast<double>() - a).cross(mesh.vertices[face[2]].cast<double>() - a);
}

/// Sums the area vectors of the faces around each vertex.
std::vector<Vec3d> vertex_area_vectors(const TriangleMesh& mesh) {
    std::vector<Vec3d> sum(mesh.vertex_count(), Vec3d::Zero());
    for (const Face& face : mesh.faces) {
        const Vec3d n = area_vector(mesh, face);
        for (std::uint32_t v : face) sum[v] += n;
    }
    return sum;
}

}  // namespace

BoundingBox bounding_box(const TriangleMesh& mesh) {
    BoundingBox box{Vec3d::Constant(std::numeric_limits<double>::infinity()),
                    Vec3d::Constant(-std::numeric_limits<double>::infinity())};
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face) {
            box.low = box.low.cwiseMin(mesh.vertices[v].cast<double>());
            box.high = box.high.cwiseMax(mesh.vertices[v].cast<double>());
        }
    return box;
}

std::vector<float> face_areas(const TriangleMesh& mesh) {
    std::vector<float> areas;
    areas.reserve(mesh.face_count());
    for (const Face& face : mesh.faces) areas.push_back(static_cast<float>(0.5 * area_vector(mesh, face).norm()));
    return areas;
}

std::vector<Vec3> face_normals(const TriangleMesh& mesh) {
    std::vector<Vec3> normals(mesh.face_count());
    std::vector<std::uint32_t> degenerate;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const Vec3d n = area_vector(mesh, mesh.faces[f]);
        const double length = n.norm();
        if (length > 0)
            normals[f] = (n / length).cast<float>();
        else
            degenerate.push_back(f);
    }
    if (degenerate.empty()) return normals;
    const std::vector<Vec3d> around = vertex_area_vectors(mesh);
    for (std::uint32_t f : degenerate) {
        const Face& face = mesh.faces[f];
        normals[f] = unit_or_up(around[face[0]] + around[face[1]] + around[face[2]]);
    }
    return normals;
}

std::vector<Vec3> face_centers(const TriangleMesh& mesh) {
    std::vector<Vec3> centers;
    centers.reserve(mesh.face_count());
    for (const auto& [a, b, c] : mesh.faces)
        centers.push_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3.0f);
    return centers;
}

std::vector<Vec3> vertex_normals(const TriangleMesh& mesh) {
    std::vector<Vec3d> sum(mesh.vertex_count(), Vec3d::Zero());
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3d pa = mesh.vertices[a].cast<double>();
        const Vec3d ab = mesh.vertices[b].cast<double>() - pa, ac = mesh.vertices[c].cast<double>() - pa;
        const Vec3d n = ab.cross(ac);
        // |n| is sine times the two edge lengths, so dividing by the squared lengths gives sine over lengths. The
        // test for zero edges is needed because fused products can leave n slightly above zero there.
        const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), bc2 = (ac - ab).squaredNorm();
        if (!(ab2 > 0 && ac2 > 0 && bc2 > 0)) continue;
        sum[a] += n / (ab2 * ac2);
        sum[b] += n / (ab2 * bc2);
        sum[c] += n / (ac2 * bc2);
    }
    std::vector<Vec3> normals;
    normals.reserve(sum.size());
    for (const Vec3d& n : sum) normals.push_back(unit_or_up(n));
    return normals;
}

Vec3 area_centroid(const TriangleMesh& mesh) {
    Vec3d weighted = Vec3d::Zero(), plain = Vec3d::Zero();
    double total = 0;
    for (const Face& face : mesh.faces) {
        const double area = area_vector(mesh, face).norm();
        Vec3d corners = Vec3d::Zero();
        for (std::uint32_t v : face) corners += mesh.vertices[v].cast<double>();
        weighted += area * corners;
        plain += corners;
        total += area;
    }
    if (total > 0) return (weighted / (3 * total)).cast<float>();
    if (mesh.faces.empty()) return Vec3::Zero();
    return (plain / (3.0 * static_cast<double>(mesh.face_count()))).cast<float>();
}

}  // namespace exemplar
