#include "host/synth/animations/skin_weights.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/synth/modeling/fairing.h"

namespace exemplar {
namespace {

using WeightMatrix = Eigen::SparseMatrix<double>;

constexpr double k_sharpness = 0.8;  // heat from a bone per area, times the squared reach of its vertices
constexpr double k_min_reach = 0.025, k_reach_share = 0.25;  // reach = least + share * distance to the bone
constexpr double k_reach_smoothing = 0.04;                   // distance over which the reaches of different bones blend
constexpr std::size_t k_max_influences = 4;
constexpr double k_fading_weight = 0.03;  // smaller weights fade to zero

double distance_to(const BoneSegment& bone, const Vec3& p) {
    const Vec3 along = bone.end - bone.begin, offset = p - bone.begin;
    const float t = std::clamp(offset.dot(along) / std::max(along.squaredNorm(), 1e-12f), 0.0f, 1.0f);
    return static_cast<double>((offset - t * along).norm());
}

/// Returns the heat that each vertex receives from its bone.
Eigen::VectorXd warmth_of(const TriangleMesh& mesh, const SurfaceLaplacian& laplacian,
                          std::span<const BoneSegment> bones, std::span<const std::uint32_t> bone_of_vertex) {
    Eigen::MatrixXd reach(laplacian.area.size(), 1);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        reach(static_cast<Eigen::Index>(v), 0) =
            k_min_reach + k_reach_share * distance_to(bones[bone_of_vertex[v]], mesh.vertices[v]);
    // A jump between bones would cause one in the second derivatives of the weights, and so in the posed curvature.
    const Eigen::VectorXd smooth = diffuse(laplacian, k_reach_smoothing, reach).cwiseMax(k_min_reach);
    return k_sharpness * laplacian.area.cwiseQuotient(smooth.cwiseAbs2());
}

/// Rises from 0 at x <= 0 to 1 at x >= 1 with continuous second derivatives.
double ramp(double x) {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * t * (10 - 15 * t + 6 * t * t);
}

/// Returns the largest weights, sharpened so that few matter. The first omitted weight is subtracted from each, so
/// that none appears or vanishes abruptly.
std::vector<Influence> strongest(const Eigen::RowVectorXd& weights) {
    std::vector<std::pair<double, std::uint32_t>> sorted;
    const double total = weights.squaredNorm();
    for (Eigen::Index b = 0; b < weights.size(); ++b) {
        const double sharp = weights[b] * weights[b] / total;
        sorted.emplace_back(-sharp * ramp(sharp / k_fading_weight), static_cast<std::uint32_t>(b));
    }
    std::sort(sorted.begin(), sorted.end());
    const double next = sorted.size() > k_max_influences ? -sorted[k_max_influences].first : 0.0;
    std::vector<Influence> influences;
    double sum = 0;
    for (const auto& [negative, bone] : sorted) {
        const double weight = -negative - next;
        if (weight < 1e-6 || influences.size() == k_max_influences) break;
        influences.push_back({bone, static_cast<float>(weight)});
        sum += weight;
    }
    for (Influence& influence : influences) influence.weight /= static_cast<float>(sum);
    std::sort(influences.begin(), influences.end(),
              [](const Influence& a, const Influence& b) { return a.bone < b.bone; });
    return influences;
}

}  // namespace

void set_skin_weights(Rig& rig, const TriangleMesh& mesh, std::span<const BoneSegment> bones,
                      std::span<const std::uint32_t> bone_of_vertex) {
    const SurfaceLaplacian laplacian = surface_laplacian(mesh);
    const Eigen::VectorXd warmth = warmth_of(mesh, laplacian, bones, bone_of_vertex);
    WeightMatrix matrix = laplacian.matrix;
    matrix.diagonal() += warmth;
    const Eigen::SimplicialLDLT<WeightMatrix> solver(matrix);
    if (solver.info() != Eigen::Success) throw MeshError("no heat equilibrium on this surface; check it for slivers");
    Eigen::MatrixXd weights(warmth.size(), static_cast<Eigen::Index>(bones.size()));
    parallel_for(bones.size(), [&](std::size_t b) {
        Eigen::VectorXd heat = Eigen::VectorXd::Zero(warmth.size());
        for (std::size_t v = 0; v < bone_of_vertex.size(); ++v)
            if (bone_of_vertex[v] == b) heat[static_cast<Eigen::Index>(v)] = 1;
        for (int pass = 0; pass < 2; ++pass) {
            const Eigen::VectorXd source = warmth.cwiseProduct(heat);
            heat = solver.solve(source);
        }
        weights.col(static_cast<Eigen::Index>(b)) = heat;
    });
    rig.influence_begin = {0};
    rig.influences.clear();
    for (Eigen::Index v = 0; v < weights.rows(); ++v) {
        const std::vector<Influence> influences = strongest(weights.row(v));
        rig.influences.insert(rig.influences.end(), influences.begin(), influences.end());
        rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
    }
}

}  // namespace exemplar
