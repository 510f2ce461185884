#include "host/parts/splitting/half_edges.h"

#include <algorithm>

namespace exemplar {
namespace {

/// A half-edge under the ends of its edge, the smaller one first.
struct KeyedHalfEdge {
    std::uint64_t key;
    std::uint32_t half_edge;
    bool operator<(const KeyedHalfEdge& other) const {
        return key != other.key ? key < other.key : half_edge < other.half_edge;
    }
};

std::vector<KeyedHalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
    std::vector<KeyedHalfEdge> sorted;
    sorted.reserve(3 * mesh.face_count());
    for (std::uint32_t h = 0; h < 3 * mesh.face_count(); ++h) {
        const std::uint64_t a = half_edge_start(mesh, h), b = half_edge_end(mesh, h);
        if (a != b) sorted.push_back({std::min(a, b) << 32 | std::max(a, b), h});
    }
    std::sort(sorted.begin(), sorted.end());
    return sorted;
}

}  // namespace

HalfEdges build_half_edges(const TriangleMesh& mesh) {
    HalfEdges edges;
    edges.twin.assign(3 * mesh.face_count(), k_invalid_index);
    const std::vector<KeyedHalfEdge> sorted = sorted_half_edges(mesh);
    for (std::size_t begin = 0, end; begin < sorted.size(); begin = end) {
        for (end = begin + 1; end < sorted.size() && sorted[end].key == sorted[begin].key;) ++end;
        const std::uint32_t first = sorted[begin].half_edge;
        if (end - begin == 2 && half_edge_start(mesh, first) == half_edge_end(mesh, sorted[begin + 1].half_edge)) {
            edges.twin[first] = sorted[begin + 1].half_edge;
            edges.twin[sorted[begin + 1].half_edge] = first;
        } else {
            for (std::size_t i = begin + 1; i < end; ++i) edges.irregular.push_back({first, sorted[i].half_edge});
        }
    }
    return edges;
}

}  // namespace exemplar
