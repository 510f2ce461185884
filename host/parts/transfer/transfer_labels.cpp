#include "host/parts/transfer/transfer_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/graphcut/alpha_expansion.h"
#include "host/mesh/queries/point_tree.h"
#include "host/mesh/topology.h"
#include "host/parts/transfer/surface_samples.h"

namespace exemplar {
namespace {

constexpr std::size_t k_source_samples = 60'000, k_target_samples = 60'000, k_samples_per_face = 4096,
                      k_target_samples_per_face = 64, k_voters = 12;

/// Shares of votes, faces x classes, and how far the source is.
struct TransferVotes {
    std::size_t classes;
    std::vector<float> share;
    std::vector<float> distance;   ///< per face: mean over its points
    std::vector<float> agreement;  ///< per face: largest n . n' of a voter, mean over its points
};

/// Collects votes of source points for the points of target faces.
class VoteCollector {
  public:
    VoteCollector(const TriangleMesh& source, std::span<const std::int32_t> label, std::size_t classes)
        : label_(label),
          classes_(classes),
          normals_(face_normals(source)),
          samples_(sample_faces(source, k_source_samples, k_samples_per_face)),
          tree_(samples_.points) {}

    TransferVotes collect(const TriangleMesh& target) const {
        const SurfaceSamples points = sample_faces(target, k_target_samples, k_target_samples_per_face);
        const std::vector<Vec3> normals = face_normals(target);
        TransferVotes votes{classes_, std::vector<float>(target.face_count() * classes_, 0),
                            std::vector<float>(target.face_count(), 0), std::vector<float>(target.face_count(), 0)};
        parallel_for(
            target.face_count(),
            [&](std::size_t f) {
                for (std::uint32_t p = points.begin[f]; p < points.begin[f + 1]; ++p)
                    add_votes(points.points[p], normals[f], f, votes);
                normalize(f, points.begin[f + 1] - points.begin[f], votes);
            },
            64);
        return votes;
    }

  private:
    void add_votes(const Vec3& point, const Vec3& normal, std::size_t f, TransferVotes& votes) const {
        std::array<std::uint32_t, k_voters> near;
        const std::size_t found = tree_.nearest(point, near);
        const float first = (samples_.points[near[0]] - point).norm();
        const auto width = static_cast<float>(samples_.spacing) + 0.25F * first;
        float best = 0;
        std::array<float, k_voters> weight;
        for (std::size_t i = 0; i < found; ++i) {
            const float agreement = std::max(normal.dot(normals_[samples_.face[near[i]]]), 0.0F);
            const float behind = ((samples_.points[near[i]] - point).norm() - first) / width;
            best = std::max(best, agreement);
            weight[i] = (agreement * agreement + 1e-3F) * std::exp(-behind * behind);
        }
        const float sum = std::accumulate(weight.begin(), weight.begin() + static_cast<std::ptrdiff_t>(found), 0.0F);
        for (std::size_t i = 0; i < found; ++i) {
            const std::int32_t voted = label_[samples_.face[near[i]]];
            const std::size_t c = voted < 0 ? classes_ - 1 : static_cast<std::size_t>(voted);
            votes.share[f * classes_ + c] += weight[i] / sum;
        }
        votes.distance[f] += first;
        votes.agreement[f] += best;
    }
    void normalize(std::size_t f, std::uint32_t points, TransferVotes& votes) const {
        const auto count = static_cast<float>(points);
        for (std::size_t c = 0; c < classes_; ++c) votes.share[f * classes_ + c] /= count;
        votes.distance[f] /= count;
        votes.agreement[f] /= count;
    }

    std::span<const std::int32_t> label_;
    std::size_t classes_;  ///< the last one is of faces without a label
    std::vector<Vec3> normals_;
    SurfaceSamples samples_;
    PointTree tree_;
};

/// Costs of labels: -log of the share of votes times the area of a face over the mean area.
std::vector<float> unary_costs(const TransferVotes& votes, const std::vector<float>& areas) {
    constexpr float k_least_share = 1e-4F;
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    const auto mean = static_cast<float>(std::max(total / static_cast<double>(areas.size()), 1e-30));
    std::vector<float> unary(votes.share.size());
    for (std::size_t i = 0; i < unary.size(); ++i)
        unary[i] =
            -std::log(std::max(votes.share[i], k_least_share)) * std::max(areas[i / votes.classes] / mean, 1e-3F);
    return unary;
}

/// Weights of the edges between faces: their length over the side of a mean face, less where the surface bends.
struct BorderCosts {
    std::vector<std::array<std::uint32_t, 2>> faces;
    std::vector<double> weight;
};
BorderCosts border_costs(const TriangleMesh& mesh, const std::vector<float>& areas, float smoothness) {
    constexpr double k_bend = 2;  // e^-2 per radian
    const Topology topology = build_topology(mesh);
    const std::vector<float> angles = exterior_dihedral_angles(mesh, topology);
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    const double side = std::max(std::sqrt(total / static_cast<double>(areas.size())), 1e-30);
    BorderCosts borders;
    borders.faces.reserve(topology.edges.size());
    borders.weight.reserve(topology.edges.size());
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
        const Edge& edge = topology.edges[e];
        if (edge.is_boundary()) continue;
        const double length = (mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm();
        borders.faces.push_back(edge.face);
        borders.weight.push_back(double{smoothness} * length / side *
                                 std::exp(-k_bend * std::abs(double{angles[e]} - std::numbers::pi)));
    }
    return borders;
}

std::vector<std::int32_t> cut_labels(const TriangleMesh& mesh, const TransferVotes& votes,
                                     const std::vector<float>& areas, float smoothness) {
    const BorderCosts borders = border_costs(mesh, areas, smoothness);
    std::vector<double> potts(votes.classes * votes.classes, 1);
    for (std::size_t c = 0; c < votes.classes; ++c) potts[c * votes.classes + c] = 0;
    return alpha_expansion(unary_costs(votes, areas), votes.classes, borders.faces, borders.weight, potts).labels;
}

/// Fills in confidence, the sure share and the median distance.
void judge(const TransferVotes& votes, const std::vector<float>& areas, double diagonal, TransferredLabels& result) {
    constexpr double k_farthest = 0.02;  // of the diagonal
    constexpr float k_least_agreement = 0.3F, k_sure = 0.8F;
    double sure = 0, total = 0;
    result.confidence.reserve(result.label.size());
    for (std::size_t f = 0; f < result.label.size(); ++f) {
        const auto c = static_cast<std::size_t>(result.label[f]);
        const bool is_near =
            double{votes.distance[f]} <= k_farthest * diagonal && votes.agreement[f] > k_least_agreement;
        result.confidence.push_back(is_near ? votes.share[f * votes.classes + c] : 0);
        total += areas[f];
        if (result.confidence.back() > k_sure) sure += areas[f];
    }
    result.sure_share = total > 0 ? sure / total : 0;
    std::vector<float> distances = votes.distance;
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    result.median_distance = double{*middle};
}

}  // namespace

TransferredLabels transfer_labels(const TriangleMesh& source, std::span<const std::int32_t> label,
                                  const TriangleMesh& target, const TransferOptions& options) {
    if (label.size() != source.face_count())
        throw UsageError(fmt::format("{} labels for {} faces", label.size(), source.face_count()));
    if (source.faces.empty() || target.faces.empty()) throw MeshError("there are no faces to transfer labels between");
    const std::int32_t most = *std::ranges::max_element(label);
    const std::size_t classes = static_cast<std::size_t>(std::max(most, 0)) + 2;
    // Both in one frame, whatever the positions of their files.
    TriangleMesh moved;
    if (source.origin != target.origin) {
        moved = source;
        const Vec3 offset = (source.origin - target.origin).cast<float>();
        for (Vec3& v : moved.vertices) v += offset;
    }
    const TriangleMesh& from = moved.faces.empty() ? source : moved;
    const TransferVotes votes = VoteCollector(from, label, classes).collect(target);
    const std::vector<float> areas = face_areas(target);
    TransferredLabels result;
    result.label = cut_labels(target, votes, areas, options.smoothness);
    judge(votes, areas, bounding_box(from).diagonal(), result);
    for (std::int32_t& l : result.label)
        if (static_cast<std::size_t>(l) == classes - 1) l = -1;
    return result;
}

}  // namespace exemplar
