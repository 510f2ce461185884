#include "apps/exemplar/bench/bench_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/random.h"
#include "host/core/statistics.h"
#include "host/mesh/queries/geodesics.h"
#include "host/mesh/topology.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

TriangleMesh refine_once(TriangleMesh mesh) {
    const Topology topology = build_topology(mesh);
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.vertices.reserve(first + topology.edges.size());
    for (const Edge& edge : topology.edges)
        mesh.vertices.push_back(0.5F * (mesh.vertices[edge.vertex[0]] + mesh.vertices[edge.vertex[1]]));
    std::vector<Face> faces;
    faces.reserve(4 * mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const auto middle = [&](std::uint32_t u, std::uint32_t v) {
            const auto edges = topology.edges_of_face(f);
            const auto joins = [&](std::uint32_t e) {
                return topology.edges[e].vertex == std::array{std::min(u, v), std::max(u, v)};
            };
            return first + *std::ranges::find_if(edges, joins);
        };
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        faces.insert(faces.end(), {Face{a, ab, ca}, Face{ab, b, bc}, Face{ca, bc, c}, Face{ab, bc, ca}});
    }
    mesh.faces = std::move(faces);
    mesh.source_face.clear();
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    return mesh;
}

/// Makes smooth noise on faces: averages over a face and its neighbors `passes` times, then scales to deviation 1.
std::vector<float> smooth_noise(const DualGraph& graph, int passes, Random& random) {
    std::vector<float> noise(graph.face_count()), mean(noise.size());
    for (float& value : noise) value = static_cast<float>(random.normal());
    for (int pass = 0; pass < passes; ++pass) {
        for (std::size_t f = 0; f < noise.size(); ++f) {
            float sum = noise[f];
            for (std::uint32_t a = graph.begin[f]; a < graph.begin[f + 1]; ++a) sum += noise[graph.arcs[a].face];
            mean[f] = sum / static_cast<float>(1 + graph.begin[f + 1] - graph.begin[f]);
        }
        noise.swap(mean);
    }
    double square = 0.0;
    for (const float value : noise) square += static_cast<double>(value) * static_cast<double>(value);
    const double deviation = std::sqrt(square / static_cast<double>(noise.size()));
    for (float& value : noise) value = static_cast<float>(static_cast<double>(value) / deviation);
    return noise;
}

/// The region of each face: the nearest of the sources.
std::vector<std::size_t> nearest_source(const DualGraph& graph, std::span<const std::uint32_t> sources) {
    const std::vector<float> distance = distances_from_sources(graph, sources);
    const std::size_t faces = graph.face_count();
    std::vector<std::size_t> nearest(faces, 0);
    for (std::size_t s = 1; s < sources.size(); ++s)
        for (std::size_t f = 0; f < faces; ++f)
            if (distance[s * faces + f] < distance[nearest[f] * faces + f]) nearest[f] = s;
    return nearest;
}

/// -log of a softmax of `scores`, faces x labels, times the areas.
void scores_to_costs(std::span<const float> area, std::size_t labels, std::vector<float>& scores) {
    std::vector<float> sorted(area.begin(), area.end());
    const float unit = upper_median(sorted);
    for (std::size_t f = 0; f < area.size(); ++f) {
        const std::span<float> of_face = std::span(scores).subspan(f * labels, labels);
        float sum = 0.0F;
        for (const float score : of_face) sum += std::exp(score);
        for (float& score : of_face) score = area[f] / unit * (std::log(sum) - score);
    }
}

}  // namespace

TriangleMesh refine(TriangleMesh mesh, std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) mesh = refine_once(std::move(mesh));
    return mesh;
}

LabeledCorpus generated_fourlegs(std::size_t count, std::size_t faces) {
    LabeledCorpus corpus;
    Progress progress("generating shapes", count);
    for (std::uint64_t seed = 1; seed <= count; ++seed) {
        check_interrupt();
        SynthShape shape = make_shape("fourleg", seed, faces);
        corpus.names = shape.labels.names;
        corpus.meshes.push_back(
            {fmt::format("fourleg_{}", seed), {}, std::move(shape.mesh), std::move(shape.labels.label)});
        progress.advance();
    }
    return corpus;
}

CutProblem make_cut_problem(const TriangleMesh& mesh, std::size_t labels) {
    const Topology topology = build_topology(mesh);
    const DualGraph graph = build_dual_graph(mesh, topology);
    const std::vector<std::size_t> truth = nearest_source(graph, sample_faces(mesh, graph, labels).face);
    constexpr float k_certainty = 2.0F, k_noise = 1.0F;
    constexpr std::array<int, 3> k_passes{0, 4, 64};
    Random random(1);
    CutProblem problem{labels, {}, std::vector<float>(mesh.face_count() * labels, 0.0F), {}, {}};
    for (std::size_t l = 0; l < labels; ++l) {
        for (const int passes : k_passes) {
            const std::vector<float> noise = smooth_noise(graph, passes, random);
            for (std::size_t f = 0; f < noise.size(); ++f) problem.unary[f * labels + l] += k_noise * noise[f];
        }
        for (std::size_t f = 0; f < truth.size(); ++f)
            if (truth[f] == l) problem.unary[f * labels + l] += k_certainty;
    }
    scores_to_costs(face_areas(mesh), labels, problem.unary);
    std::vector<float> length;
    for (const Edge& edge : topology.edges) {
        if (edge.is_boundary()) continue;
        problem.edges.push_back(edge.face);
        length.push_back((mesh.vertices[edge.vertex[0]] - mesh.vertices[edge.vertex[1]]).norm());
    }
    std::vector<float> sorted = length;
    const float unit = upper_median(sorted);
    for (const float l : length) problem.weight.push_back(static_cast<double>(l / unit));
    problem.compatibility.assign(labels * labels, 1.0);
    for (std::size_t l = 0; l < labels; ++l) problem.compatibility[l * labels + l] = 0.0;
    return problem;
}

double energy_of_conditional_modes(const CutProblem& problem) {
    const std::size_t labels = problem.labels, nodes = problem.unary.size() / labels;
    std::vector<std::vector<std::pair<std::uint32_t, double>>> neighbors(nodes);
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
        const auto [a, b] = problem.edges[e];
        neighbors[a].emplace_back(b, problem.weight[e]);
        neighbors[b].emplace_back(a, problem.weight[e]);
    }
    std::vector<std::int32_t> label(nodes);
    std::vector<double> cost(labels);
    const auto best_label = [&](std::size_t i, bool alone) {
        for (std::size_t l = 0; l < labels; ++l) cost[l] = static_cast<double>(problem.unary[i * labels + l]);
        if (!alone)
            for (const auto& [j, weight] : neighbors[i])
                for (std::size_t l = 0; l < labels; ++l)
                    cost[l] += weight * problem.compatibility[l * labels + static_cast<std::size_t>(label[j])];
        return static_cast<std::int32_t>(std::ranges::min_element(cost) - cost.begin());
    };
    for (std::size_t i = 0; i < nodes; ++i) label[i] = best_label(i, true);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < nodes; ++i)
            if (const std::int32_t best = best_label(i, false); best != label[i]) label[i] = best, changed = true;
    }
    return AlphaExpansion(nodes, problem.edges).evaluate(problem.energy(), labels, label);
}

BoostingData make_boosting_data(std::size_t rows, std::size_t columns, std::size_t classes) {
    constexpr double k_zeros = 0.3;
    Random random(1);
    BoostingData data;
    data.features.rows = rows;
    data.features.values.reserve(rows * columns);
    for (std::size_t i = 0; i < rows; ++i) {
        data.labels.push_back(static_cast<std::int32_t>(random.index(classes)));
        data.weights.push_back(static_cast<float>(random.uniform(0.1, 1.0)));
    }
    for (std::size_t f = 0; f < columns; ++f) {
        const double spread = random.uniform(0.0, 0.5);
        const std::span<float> column = data.features.add(fmt::format("f{}", f));
        for (std::size_t i = 0; i < rows; ++i) {
            const std::size_t center = (static_cast<std::size_t>(data.labels[i]) * 7 + f) % classes;
            const double value = random.normal() + spread * static_cast<double>(center);
            column[i] = random.uniform() < k_zeros ? 0.0F : static_cast<float>(value);
        }
    }
    return data;
}

BoostedStumps random_stumps(std::size_t stumps, std::size_t columns, std::size_t classes) {
    Random random(1);
    BoostedStumps classifier{.class_count = static_cast<std::uint32_t>(classes), .stumps = {}, .elsewhere = {}};
    std::array<std::uint64_t, 40> sets{};
    for (std::uint64_t& set : sets) set = 1 + random.index((1U << classes) - 1);
    for (std::size_t m = 0; m < stumps; ++m)
        classifier.stumps.push_back({static_cast<std::uint32_t>(random.index(columns)),
                                     static_cast<float>(random.normal()), static_cast<float>(random.uniform(-0.2, 0.2)),
                                     static_cast<float>(random.uniform(-0.2, 0.2)), sets[random.index(sets.size())]});
    classifier.elsewhere.assign(stumps * classes, 0.0F);
    return classifier;
}

}  // namespace exemplar
