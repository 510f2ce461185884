#include "host/mesh/vertex_neighbors.h"

#include <algorithm>
#include <iterator>

namespace exemplar {

VertexNeighbors build_vertex_neighbors(std::span<const Face> faces, std::size_t vertex_count) {
    std::vector<std::uint32_t> begin(vertex_count + 1, 0);
    for (const Face& face : faces)
        for (const std::uint32_t v : face) begin[v + 1] += 2;
    for (std::size_t v = 0; v < vertex_count; ++v) begin[v + 1] += begin[v];
    // Adds both other corners of each face; most occur twice, once for each face at the edge.
    std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1), corners(begin.back());
    for (const Face& face : faces)
        for (std::size_t i = 0; i < 3; ++i) {
            corners[next[face[i]]++] = face[(i + 1) % 3];
            corners[next[face[i]]++] = face[(i + 2) % 3];
        }
    VertexNeighbors result;
    result.begin.reserve(vertex_count + 1);
    result.begin.push_back(0);
    for (std::uint32_t v = 0; v < vertex_count; ++v) {
        const auto first = corners.begin() + begin[v], last = corners.begin() + begin[v + 1];
        std::sort(first, last);
        std::copy_if(first, std::unique(first, last), std::back_inserter(result.vertex),
                     [v](std::uint32_t other) { return other != v; });
        result.begin.push_back(static_cast<std::uint32_t>(result.vertex.size()));
    }
    return result;
}

}  // namespace exemplar
