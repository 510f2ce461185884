#include "host/labeling/painting/completion.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "host/core/disjoint_sets.h"
#include "host/core/parallel.h"
#include "host/graphcut/alpha_expansion.h"
#include "host/mesh/queries/distance_queue.h"

namespace exemplar {
namespace {

constexpr float k_far = std::numeric_limits<float>::infinity();
constexpr float k_painted_cost = 1e4F;

/// Scores labels by the ratio of their distances alone, as long as there are no features: the nearest wins.
void score_by_distance(const std::vector<std::vector<float>>& distance, std::size_t face, std::span<float> score) {
    constexpr float k_ratio_weight = 4, k_least = 0.02F;
    float nearest = k_far;
    for (const auto& of_label : distance)
        if (!of_label.empty()) nearest = std::min(nearest, of_label[face]);
    if (nearest == k_far) return;
    for (std::size_t c = 0; c < score.size(); ++c)
        if (!distance[c].empty()) score[c] = -k_ratio_weight * distance[c][face] / (nearest + k_least);
}

/// Turns scores into probabilities, in place. Each label that has a finite score gets a part of `floor`.
void softmax_with_floor(std::span<float> score, float floor) {
    const float highest = *std::max_element(score.begin(), score.end());
    if (highest == -k_far) return std::fill(score.begin(), score.end(), 0.0F);
    float sum = 0, count = 0;
    for (float& s : score) {
        count += s > -k_far ? 1 : 0;
        sum += s = std::exp(s - highest);
    }
    for (float& s : score) s = s > 0 ? (1 - floor) * s / sum + floor / count : 0;
}

}  // namespace

LabelCompletion::LabelCompletion(const TriangleMesh& mesh, const CompletionOptions& options) : options_(options) {
    const Topology topology = build_topology(mesh);
    area_ = face_areas(mesh);
    const float total = std::max(std::accumulate(area_.begin(), area_.end(), 0.0F), 1e-30F);
    const float unit = std::sqrt(total);
    for (float& area : area_) area /= total;
    const std::vector<float> angle = exterior_dihedral_angles(mesh, topology);

    graph_ = build_dual_graph(mesh, topology);
    for (DualGraph::Arc& arc : graph_.arcs) arc.length /= unit;
    for (std::size_t e = 0; e < topology.edges.size(); ++e) {
        const Edge& edge = topology.edges[e];
        if (edge.is_boundary()) continue;
        const float length = (mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm() / unit;
        const float dihedral = std::min(angle[e] / std::numbers::pi_v<float>, 1.0F);
        edges_.push_back(edge.face);
        const double smooth = -std::log(1 - static_cast<double>(dihedral) + 1e-3);
        edge_cost_.push_back(static_cast<double>(length) * (options_.lambda * std::max(0.0, smooth) + options_.mu));
        for (std::uint32_t side = 0; side < 2; ++side)
            for (std::uint32_t a = graph_.begin[edge.face[side]]; a < graph_.begin[edge.face[side] + 1]; ++a)
                if (graph_.arcs[a].face == edge.face[1 - side])
                    graph_.arcs[a].length *= 1 + options_.concave_length * (1 - dihedral);
    }
}

std::vector<float> LabelCompletion::distances(std::span<const std::int32_t> painted, std::int32_t label) const {
    std::vector<float> distance(area_.size(), k_far);
    DistanceQueue queue;
    for (std::uint32_t f = 0; f < area_.size(); ++f)
        if (painted[f] == label) queue.push(0, f), distance[f] = 0;
    while (!queue.empty()) {
        const auto [at, face] = queue.pop();
        if (at > distance[face]) continue;
        for (std::uint32_t a = graph_.begin[face]; a < graph_.begin[face + 1]; ++a) {
            const float next = at + graph_.arcs[a].length;
            if (next >= distance[graph_.arcs[a].face]) continue;
            distance[graph_.arcs[a].face] = next;
            queue.push(next, graph_.arcs[a].face);
        }
    }
    return distance;
}

// Per face and label: the smallest squared distance of descriptors to a painted face of the label.
std::vector<float> LabelCompletion::likeness(std::span<const std::int32_t> painted, std::size_t labels) const {
    constexpr std::size_t k_examples = 24;  // of each painted patch
    DisjointSets patches(area_.size());
    for (const auto& [a, b] : edges_)
        if (painted[a] >= 0 && painted[a] == painted[b]) patches.join(a, b);
    std::vector<std::vector<std::uint32_t>> members(area_.size());
    for (std::uint32_t f = 0; f < area_.size(); ++f)
        if (painted[f] >= 0) members[patches.find(f)].push_back(f);
    std::vector<std::uint32_t> example;
    for (const auto& patch : members)
        for (std::size_t i = 0, n = std::min(k_examples, patch.size()); i < n; ++i)
            example.push_back(patch[i * patch.size() / n]);

    using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto d = static_cast<Eigen::Index>(descriptors_.dimensions);
    RowMajor examples(static_cast<Eigen::Index>(example.size()), d);
    for (std::size_t i = 0; i < example.size(); ++i)
        examples.row(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::RowVectorXf>(descriptors_.values.data() + example[i] * descriptors_.dimensions, d);
    const Eigen::VectorXf norms = examples.rowwise().squaredNorm();
    std::vector<float> nearest(area_.size() * labels, k_far);
    parallel_ranges(area_.size(), 512, [&](std::size_t begin, std::size_t end) {
        const auto rows = static_cast<Eigen::Index>(end - begin);
        const Eigen::Map<const RowMajor> block(descriptors_.values.data() + begin * descriptors_.dimensions, rows, d);
        const Eigen::VectorXf own = block.rowwise().squaredNorm();
        const RowMajor products = block * examples.transpose();
        for (std::size_t f = begin; f < end; ++f) {
            const auto row = static_cast<Eigen::Index>(f - begin);
            for (std::size_t i = 0; i < example.size(); ++i) {
                const auto column = static_cast<Eigen::Index>(i);
                float& best = nearest[f * labels + static_cast<std::size_t>(painted[example[i]])];
                best = std::min(best, std::max(0.0F, own[row] + norms[column] - 2 * products(row, column)));
            }
        }
    });
    return nearest;
}

LabelCompletion::StrokeDistances LabelCompletion::stroke_distances(std::span<const std::int32_t> painted,
                                                                   std::size_t labels) const {
    std::vector<bool> known(labels, false);
    for (const std::int32_t label : painted)
        if (label >= 0) known[static_cast<std::size_t>(label)] = true;
    StrokeDistances strokes;
    if (descriptors_.dimensions > 0) strokes.unlike = likeness(painted, labels);
    strokes.distance.resize(labels);
    parallel_for(labels, [&](std::size_t c) {
        if (known[c]) strokes.distance[c] = distances(painted, static_cast<std::int32_t>(c));
    });
    return strokes;
}

float LabelCompletion::score(const StrokeDistances& strokes, std::size_t face, std::size_t label) const {
    const std::vector<float>& distance = strokes.distance[label];
    const float near = distance.empty() ? 0 : std::exp(-distance[face] / options_.reach);
    const bool compared = !distance.empty() && !strokes.unlike.empty();
    const float unlike = compared ? strokes.unlike[face * strokes.distance.size() + label] : 0;
    if (evidence_.probabilities.empty())
        return distance.empty() ? -k_far : options_.nearness * near - options_.likeness * unlike;
    const std::size_t suggested = evidence_.labels(area_.size());  // labels may have been added since
    const float probability = label < suggested ? evidence_.probabilities[face * suggested + label] : 0;
    // A model that errs at a stroke errs wherever the surface is like that, so the stroke counts there, too.
    const float elsewhere = compared ? options_.elsewhere : 0;
    const float corrected = (elsewhere + (1 - elsewhere) * near) * std::exp(-options_.correction_likeness * unlike);
    return options_.trust * std::log(probability + 0.05F) + options_.correction * corrected;
}

std::vector<float> LabelCompletion::probabilities(std::span<const std::int32_t> painted, std::size_t labels) const {
    const StrokeDistances strokes = stroke_distances(painted, labels);
    const bool distance_alone = strokes.unlike.empty() && evidence_.probabilities.empty();
    std::vector<float> result(area_.size() * labels, 0);
    parallel_ranges(area_.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f) {
            const std::span<float> scores = std::span(result).subspan(f * labels, labels);
            for (std::size_t c = 0; c < labels; ++c) scores[c] = score(strokes, f, c);
            if (distance_alone) score_by_distance(strokes.distance, f, scores);
            softmax_with_floor(scores, options_.outlier);
        }
    });
    return result;
}

std::vector<std::int32_t> LabelCompletion::cut(std::span<const std::int32_t> painted,
                                               std::span<const float> probability, std::size_t labels) const {
    std::vector<float> unary(probability.size());
    for (std::size_t f = 0; f < painted.size(); ++f)
        for (std::size_t c = 0; c < labels; ++c) {
            float& cost = unary[f * labels + c];
            if (painted[f] >= 0)
                cost = painted[f] == static_cast<std::int32_t>(c) ? 0 : k_painted_cost;
            else
                cost = -area_[f] * std::log(std::max(probability[f * labels + c], 1e-6F));
        }
    std::vector<double> compatibility(labels * labels, 1.0);
    for (std::size_t c = 0; c < labels; ++c) compatibility[c * labels + c] = 0;
    if (evidence_.probabilities.empty())
        return alpha_expansion(unary, labels, edges_, edge_cost_, compatibility).labels;
    const std::size_t suggested = evidence_.labels(painted.size());
    for (std::size_t c = 0; c < std::min(suggested, labels); ++c)
        for (std::size_t other = 0; other < std::min(suggested, labels); ++other)
            compatibility[c * labels + other] = evidence_.compatibility[c * suggested + other];
    return alpha_expansion(unary, labels, evidence_.edges, evidence_.edge_cost, compatibility).labels;
}

CompletedLabels LabelCompletion::complete(std::span<const std::int32_t> painted, std::size_t labels) const {
    const std::size_t faces = area_.size();
    CompletedLabels completed;
    completed.label.assign(faces, -1);
    completed.confidence.assign(faces, 0);
    const bool nothing = std::ranges::all_of(painted, [](std::int32_t label) { return label < 0; });
    if (nothing && evidence_.probabilities.empty()) return completed;
    const std::vector<float> probability = probabilities(painted, labels);
    completed.label = cut(painted, probability, labels);
    for (std::size_t f = 0; f < faces; ++f)
        completed.confidence[f] =
            painted[f] >= 0 ? 1 : probability[f * labels + static_cast<std::size_t>(completed.label[f])];
    return completed;
}

}  // namespace exemplar
