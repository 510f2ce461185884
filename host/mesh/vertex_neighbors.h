#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// The vertices that share an edge with each vertex, in increasing order, as compressed rows.
struct VertexNeighbors {
    std::vector<std::uint32_t> begin;  ///< V + 1 offsets
    std::vector<std::uint32_t> vertex;
    std::size_t vertex_count() const { return begin.size() - 1; }
    std::span<const std::uint32_t> of(std::size_t v) const {
        return {vertex.data() + begin[v], vertex.data() + begin[v + 1]};
    }
};
VertexNeighbors build_vertex_neighbors(std::span<const Face> faces, std::size_t vertex_count);

}  // namespace exemplar
