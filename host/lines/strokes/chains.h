#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// A segment of a chain, traversed from its first end to its second, or reversed.
struct ChainLink {
    std::uint32_t segment = 0;
    bool reversed = false;
};

/// A sequence of segments that continue each other over the surface (thesis Sec. 5.7, after Markosian et al. 1997).
struct Chain {
    std::vector<ChainLink> links;
    bool closed = false;  ///< the last link continues in the first
};

/// Joins the segments of one line type, as returned by extract_lines, to chains; each segment is in exactly one
/// chain. Two segments of a family are joined if they end on the two sides of an edge with exactly two faces (with
/// `across_sharp_edges` false: that is not marked as sharp), or at a vertex where no third segment ends. The segment
/// with the smallest index of a chain is traversed from its first end to its second; a closed chain starts with it.
/// Chains are ordered by this index, so the result is deterministic. Throws UsageError if a segment's face does not
/// exist or neighbors are not those of the faces.
std::vector<Chain> chain_segments(std::span<const Face> faces, std::span<const FaceNeighbors> neighbors,
                                  std::span<const LineSegment> segments, bool across_sharp_edges = true);

}  // namespace exemplar
