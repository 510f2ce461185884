#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/parts/splitting/half_edges.h"

namespace exemplar {

/// A closed path along the cut of one part, with the part on its left. No vertex occurs twice.
struct CutLoop {
    std::uint32_t part;
    std::vector<std::uint32_t> half_edges;  ///< of faces of the part, in order; at least three
};

/// Loops that share cut edges, directly or through others. Both sides of each of their edges are in the group, so the
/// loops of a group, as directed edges, add up to nothing.
using CutLoopGroup = std::vector<CutLoop>;

struct CutLoops {
    std::vector<CutLoopGroup> groups;
    /// Number of cut edges that are in no group, because their cut ends at a boundary or a non-manifold edge of the
    /// mesh.
    std::size_t open_edges = 0;
};

/// Finds the loops along which parts are cut from each other. `part_of_face` has one entry a face.
CutLoops find_cut_loops(const TriangleMesh& mesh, const HalfEdges& edges, std::span<const std::uint32_t> part_of_face);

}  // namespace exemplar
