#include "host/hatching/features/direction_smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>

#include "host/core/errors.h"
#include "host/mesh/curvature/tangent_tensors.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {
namespace {

using Complex = std::complex<double>;
using Matrix = Eigen::SparseMatrix<Complex>;

/// Cotangents lie in [1/8, 8]: needles must not break the system, and weights must be positive.
double clamped_cotangent(const Vec3d& apex, const Vec3d& a, const Vec3d& b) {
    const Vec3d u = a - apex, v = b - apex;
    const double sine = u.cross(v).norm(), cosine = u.dot(v);
    return sine > 0 ? std::clamp(cosine / sine, 0.125, 8.0) : 0.125;
}

/// The doubled angle of a vector in a frame: unit, or zero.
Complex doubled_in_frame(const TangentFrame& frame, const Vec3& vector) {
    const Complex z(static_cast<double>(frame.tangent.dot(vector)), static_cast<double>(frame.bitangent.dot(vector)));
    const double square = std::norm(z);
    return square > 0 ? z * z / square : Complex();
}

}  // namespace

struct DirectionSmoother::Parts {
    std::vector<TangentFrame> frames;
    Matrix laplacian;  // hermitian: sum over edges of weight |z_i - r_ij z_j|^2
    Eigen::VectorXd diagonal;
};

DirectionSmoother::DirectionSmoother(const TriangleMesh& mesh, std::span<const Vec3> normals)
    : parts_(std::make_unique<Parts>()) {
    const auto count = static_cast<Eigen::Index>(mesh.vertex_count());
    for (const Vec3& normal : normals) parts_->frames.push_back(frame_of_normal(normal));
    parts_->diagonal = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Triplet<Complex>> entries;
    const auto add = [&](std::uint32_t i, std::uint32_t j, double weight) {
        // The rotation that transports a direction from the frame of j to the frame of i.
        const TangentFrame &to = parts_->frames[i], &from = parts_->frames[j];
        const TangentRotation turn = rotation_to(to, from.tangent, from.normal);
        const Complex z(static_cast<double>(turn.cosine), static_cast<double>(turn.sine));
        entries.emplace_back(i, j, -weight * z * z / std::max(std::norm(z), 1e-12));
        parts_->diagonal[i] += weight;
    };
    for (const Face& face : mesh.faces) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = face[k], b = face[(k + 1) % 3];
            if (a == b) continue;
            const double weight =
                0.5 * clamped_cotangent(mesh.vertices[face[(k + 2) % 3]].cast<double>(),
                                        mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>());
            add(a, b, weight);
            add(b, a, weight);
        }
    }
    for (Eigen::Index v = 0; v < count; ++v) entries.emplace_back(v, v, parts_->diagonal[v]);
    parts_->laplacian.resize(count, count);
    parts_->laplacian.setFromTriplets(entries.begin(), entries.end());
}

DirectionSmoother::~DirectionSmoother() = default;

std::vector<Vec3> DirectionSmoother::complete(std::span<const Vec3> directions,
                                              std::span<const float> confidence) const {
    const std::size_t count = parts_->frames.size();
    if (directions.size() != count || confidence.size() != count)
        throw UsageError("directions to complete: one direction and one confidence per vertex are needed");
    // A trace of regularization keeps parts without any direction solvable; it is too weak to be seen elsewhere.
    constexpr double k_trace = 1e-7, k_max_weight = 1e4;
    Matrix system = parts_->laplacian;
    Eigen::VectorXcd right(static_cast<Eigen::Index>(count));
    for (std::size_t v = 0; v < count; ++v) {
        const auto i = static_cast<Eigen::Index>(v);
        const Complex direction = doubled_in_frame(parts_->frames[v], directions[v]);
        const double c = direction == Complex() ? 0 : std::clamp(static_cast<double>(confidence[v]), 0.0, 1.0);
        const double scale = std::max(parts_->diagonal[i], 1e-12);
        const double weight = scale * std::min(c / std::max(1 - c, 1e-12), k_max_weight);
        system.coeffRef(i, i) += weight + scale * k_trace;
        right[i] = weight * direction;
    }
    const Eigen::SimplicialLDLT<Matrix> solver(system);
    const Eigen::VectorXcd solution = solver.solve(right);
    std::vector<Vec3> result(count, Vec3::Zero());
    for (std::size_t v = 0; v < count; ++v) {
        const Complex z = solution[static_cast<Eigen::Index>(v)];
        if (!(std::abs(z) > 1e-6)) continue;
        const Complex half = std::sqrt(z / std::abs(z));
        const TangentFrame& frame = parts_->frames[v];
        result[v] = static_cast<float>(half.real()) * frame.tangent + static_cast<float>(half.imag()) * frame.bitangent;
    }
    return result;
}

}  // namespace exemplar
