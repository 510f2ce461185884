#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/core/parallel.h"
#include "host/labeling/features/feature_families.h"
#include "host/shape/log_bins.h"

namespace exemplar {
namespace {

constexpr std::array<double, 4> k_dihedral_radii{0.005, 0.01, 0.02, 0.04};
constexpr std::size_t k_scales = k_dihedral_radii.size() + 1;  ///< the edge itself and its surroundings
constexpr int k_exponents = 10;
constexpr double k_context_radius = 0.05;
constexpr std::size_t k_block = 1024;  ///< edges whose neighbors are collected together

/// The graph of edge midpoints; edge_of[e] is the interior edge of topology edge e, or k_invalid_index.
DualGraph midpoint_graph(const PreparedMesh& prepared, const InteriorEdges& edges,
                         const std::vector<std::uint32_t>& edge_of) {
    const auto midpoint = [&](std::uint32_t e) -> Vec3 {
        return 0.5F * (prepared.mesh.vertices[edges.vertex[e][0]] + prepared.mesh.vertices[edges.vertex[e][1]]);
    };
    DualGraph graph;
    graph.begin.push_back(0);
    for (std::uint32_t e = 0; e < edges.face.size(); ++e) {
        for (const std::uint32_t face : edges.face[e]) {
            for (const std::uint32_t other : prepared.topology.edges_of_face(face)) {
                const std::uint32_t near = edge_of[other];
                if (near == k_invalid_index || near == e) continue;
                graph.arcs.push_back({near, (midpoint(e) - midpoint(near)).norm()});
            }
        }
        graph.begin.push_back(static_cast<std::uint32_t>(graph.arcs.size()));
    }
    return graph;
}

/// Length-weighted mean of min(omega / pi, 1) within each radius; the edge's own value where the lengths vanish.
std::array<float, k_scales> mean_dihedrals(const PreparedMesh& prepared, const InteriorEdges& edges, std::uint32_t edge,
                                           Neighborhood near) {
    std::array<float, k_scales> means{edges.dihedral[edge]};
    double length = 0.0, sum = 0.0;
    std::size_t added = 0;
    for (std::size_t scale = 0; scale < k_dihedral_radii.size(); ++scale) {
        const float radius = static_cast<float>(k_dihedral_radii[scale]) * prepared.median_distance;
        for (; added < near.faces.size() && near.faces[added].distance <= radius; ++added) {
            const std::uint32_t other = near.faces[added].face;
            length += static_cast<double>(edges.length[other]);
            sum += static_cast<double>(edges.length[other]) * static_cast<double>(edges.dihedral[other]);
        }
        means[scale + 1] = length > 0.0 ? static_cast<float>(sum / length) : edges.dihedral[edge];
    }
    return means;
}

/// Neighbors of one block of edges, before the blocks are joined.
struct NeighborBlock {
    std::vector<std::uint32_t> count, edge;
    std::vector<std::uint8_t> bin;
    void add(Neighborhood near, const std::array<float, EdgeNeighborhood::k_bins + 1>& limits) {
        std::uint8_t current = 0;
        for (const auto& [other, distance] : near.faces) {
            while (current + 1U < EdgeNeighborhood::k_bins && limits[current + 1U] <= distance) ++current;
            edge.push_back(other);
            bin.push_back(current);
        }
        count.push_back(static_cast<std::uint32_t>(near.faces.size()));
    }
};

EdgeNeighborhood join_blocks(std::vector<NeighborBlock> blocks) {
    EdgeNeighborhood joined;
    joined.begin.push_back(0);
    std::size_t size = 0;
    for (const NeighborBlock& block : blocks) size += block.edge.size();
    joined.edge.reserve(size);
    joined.bin.reserve(size);
    for (NeighborBlock& block : blocks) {
        for (const std::uint32_t count : block.count) joined.begin.push_back(joined.begin.back() + count);
        joined.edge.insert(joined.edge.end(), block.edge.begin(), block.edge.end());
        joined.bin.insert(joined.bin.end(), block.bin.begin(), block.bin.end());
        block = {};  // blocks and the whole need not be in memory together
    }
    return joined;
}

/// Area-weighted mean over the faces around a vertex.
std::array<float, 4> vertex_value(const PreparedMesh& prepared, const std::vector<std::array<float, 4>>& of_face,
                                  std::uint32_t vertex) {
    std::array<double, 4> sum{};
    double total = 0.0;
    for (const std::uint32_t f : prepared.topology.faces_of_vertex(vertex)) {
        const double weight = static_cast<double>(prepared.area_share[f]);
        for (std::size_t k = 0; k < 4; ++k) sum[k] += weight * static_cast<double>(of_face[f][k]);
        total += weight;
    }
    std::array<float, 4> mean{};
    if (total > 0.0) {
        for (std::size_t k = 0; k < 4; ++k) mean[k] = static_cast<float>(sum[k] / total);
    }
    return mean;
}

}  // namespace

InteriorEdges interior_edges(const PreparedMesh& prepared) {
    const std::vector<float> angles = exterior_dihedral_angles(prepared.mesh, prepared.topology);
    InteriorEdges edges;
    std::vector<std::uint32_t> edge_of(prepared.topology.edges.size(), k_invalid_index);
    for (std::size_t e = 0; e < edge_of.size(); ++e) {
        const Edge& edge = prepared.topology.edges[e];
        if (edge.is_boundary()) continue;
        edge_of[e] = static_cast<std::uint32_t>(edges.face.size());
        edges.face.push_back(edge.face);
        edges.vertex.push_back(edge.vertex);
        edges.length.push_back(
            (prepared.mesh.vertices[edge.vertex[0]] - prepared.mesh.vertices[edge.vertex[1]]).norm());
        edges.dihedral.push_back(std::min(angles[e] / std::numbers::pi_v<float>, 1.0F));
    }
    edges.graph = midpoint_graph(prepared, edges, edge_of);
    return edges;
}

FeatureMatrix dihedral_features(const PreparedMesh& prepared, const InteriorEdges& edges, EdgeNeighborhood& near) {
    FeatureMatrix matrix;
    matrix.rows = edges.face.size();
    for (std::size_t scale = 0; scale < k_scales; ++scale) {
        const std::string name = scale == 0 ? "dihedral.edge" : at_radius("dihedral.mean", k_dihedral_radii[scale - 1]);
        for (int exponent = 1; exponent <= k_exponents; ++exponent) matrix.add(fmt::format("{}^{}", name, exponent));
    }
    const float reach = static_cast<float>(k_context_radius) * prepared.median_distance;
    const std::size_t max_edges = max_edge_neighborhood(matrix.rows);
    const auto limits = log_bin_edges<EdgeNeighborhood::k_bins>(reach);
    std::vector<NeighborBlock> blocks((matrix.rows + k_block - 1) / k_block);
    parallel_for(blocks.size(), [&](std::size_t b) {
        GeodesicSearch search(edges.graph);
        for (std::size_t e = b * k_block; e < std::min((b + 1) * k_block, matrix.rows); ++e) {
            const auto edge = static_cast<std::uint32_t>(e);
            const Neighborhood found = find_bounded_neighborhood(search, edge, reach, 2, max_edges);
            blocks[b].add(found, limits);
            const auto means = mean_dihedrals(prepared, edges, edge, found);
            for (std::size_t scale = 0; scale < k_scales; ++scale) {
                float power = 1.0F;
                for (std::size_t k = 0; k < k_exponents; ++k)
                    matrix.column(scale * k_exponents + k)[e] = power *= means[scale];
            }
        }
    });
    near = join_blocks(std::move(blocks));
    return matrix;
}

FeatureMatrix edge_curvature_features(const PreparedMesh& prepared, const InteriorEdges& edges,
                                      const CurvatureFamily::FaceValues& values) {
    constexpr std::array<const char*, 4> k_names{"k1", "k2", "|dk1|", "|dk2|"};
    FeatureMatrix matrix;
    matrix.rows = edges.face.size();
    for (const double radius : CurvatureFamily::k_pairwise_radii) {
        for (const char* name : k_names) matrix.add(at_radius(std::string("curvature.") + name, radius));
    }
    std::vector<std::array<float, 4>> of_vertex(prepared.mesh.vertex_count());
    for (std::size_t scale = 0; scale < values.size(); ++scale) {
        const auto average = [&](std::size_t v) {
            of_vertex[v] = vertex_value(prepared, values[scale], static_cast<std::uint32_t>(v));
        };
        parallel_for(of_vertex.size(), average, 1024);
        for (std::size_t k = 0; k < k_names.size(); ++k) {
            const std::span<float> column = matrix.column(scale * k_names.size() + k);
            for (std::size_t e = 0; e < matrix.rows; ++e) {
                column[e] = 0.5F * (of_vertex[edges.vertex[e][0]][k] + of_vertex[edges.vertex[e][1]][k]);
            }
        }
    }
    return matrix;
}

FeatureMatrix difference_features(const InteriorEdges& edges, const FeatureMatrix& unary) {
    FeatureMatrix matrix;
    matrix.rows = edges.face.size();
    matrix.names = unary.names;
    matrix.values.resize(matrix.cols() * matrix.rows);
    parallel_for(matrix.cols(), [&](std::size_t k) {
        const std::span<const float> values = unary.column(k);
        const std::span<float> column = matrix.column(k);
        for (std::size_t e = 0; e < matrix.rows; ++e) {
            column[e] = std::abs(values[edges.face[e][0]] - values[edges.face[e][1]]);
        }
    });
    return matrix;
}

}  // namespace exemplar
