#include "host/synth/modeling/fairing.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/errors.h"

namespace exemplar {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double k_min_cotangent = 0.02;  // a negative weight would make heat flow uphill

/// Returns the cotangents of a triangle's angles.
std::array<double, 3> cotangents(const TriangleMesh& mesh, const Face& face) {
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d corner = mesh.vertices[face[i]].cast<double>();
        const Vec3d u = mesh.vertices[face[(i + 1) % 3]].cast<double>() - corner;
        const Vec3d v = mesh.vertices[face[(i + 2) % 3]].cast<double>() - corner;
        result[i] = u.dot(v) / std::max(u.cross(v).norm(), 1e-12);
    }
    return result;
}

/// Returns the areas of the parts of a triangle nearest to its corners (Meyer et al. 2003): Voronoi areas, or halves
/// and quarters if obtuse.
std::array<double, 3> corner_areas(const TriangleMesh& mesh, const Face& face, const std::array<double, 3>& cot) {
    std::array<double, 3> squared{};  // lengths of the sides opposite to the corners
    for (std::size_t i = 0; i < 3; ++i)
        squared[i] =
            static_cast<double>((mesh.vertices[face[(i + 1) % 3]] - mesh.vertices[face[(i + 2) % 3]]).squaredNorm());
    const double area = (cot[0] * squared[0] + cot[1] * squared[1] + cot[2] * squared[2]) / 4;
    const bool is_obtuse = std::ranges::min(cot) < 0;
    std::array<double, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        result[i] = is_obtuse ? (cot[i] < 0 ? area / 2 : area / 4) : (cot[j] * squared[j] + cot[k] * squared[k]) / 8;
    }
    return result;
}

Eigen::MatrixXd solve(const SparseMatrix& matrix, const Eigen::MatrixXd& right) {
    const Eigen::SimplicialLDLT<SparseMatrix> solver(matrix);
    if (solver.info() != Eigen::Success)
        throw MeshError("a surface cannot be smoothed; check it for collapsed triangles and loose vertices");
    return solver.solve(right);
}

SparseMatrix diagonal(const Eigen::VectorXd& values) {
    SparseMatrix result(values.size(), values.size());
    result.setIdentity();
    result.diagonal() = values;
    return result;
}

}  // namespace

SurfaceLaplacian surface_laplacian(const TriangleMesh& mesh) {
    const auto count = static_cast<Eigen::Index>(mesh.vertex_count());
    SurfaceLaplacian result{SparseMatrix(count, count), Eigen::VectorXd::Zero(count)};
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(mesh.face_count() * 12);
    for (const Face& face : mesh.faces) {
        const std::array<double, 3> cot = cotangents(mesh, face), areas = corner_areas(mesh, face, cot);
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = face[(i + 1) % 3], b = face[(i + 2) % 3];
            const double half = std::max(cot[i], k_min_cotangent) / 2;
            entries.emplace_back(a, b, -half);
            entries.emplace_back(b, a, -half);
            entries.emplace_back(a, a, half);
            entries.emplace_back(b, b, half);
            result.area[face[i]] += areas[i];
        }
    }
    result.matrix.setFromTriplets(entries.begin(), entries.end());
    const double least = 1e-6 * result.area.mean();
    result.area = result.area.cwiseMax(std::max(least, 1e-30));
    return result;
}

Eigen::MatrixXd diffuse(const SurfaceLaplacian& laplacian, double distance, const Eigen::MatrixXd& functions) {
    const SparseMatrix matrix = diagonal(laplacian.area) + distance * distance * laplacian.matrix;
    return solve(matrix, Eigen::MatrixXd(laplacian.area.asDiagonal() * functions));
}

void fair(TriangleMesh& mesh, double width) {
    const SurfaceLaplacian laplacian = surface_laplacian(mesh);
    const double time = std::pow(width / (2 * std::numbers::pi), 4);
    const SparseMatrix flow = laplacian.matrix * diagonal(laplacian.area.cwiseInverse()) * laplacian.matrix;
    Eigen::MatrixXd positions(laplacian.area.size(), 3);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        positions.row(static_cast<Eigen::Index>(v)) = mesh.vertices[v].cast<double>().transpose();
    const SparseMatrix matrix = diagonal(laplacian.area) + time * flow;
    const Eigen::MatrixXd smooth = solve(matrix, laplacian.area.asDiagonal() * positions);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        mesh.vertices[v] = smooth.row(static_cast<Eigen::Index>(v)).transpose().cast<float>();
}

}  // namespace exemplar
