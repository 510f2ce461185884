#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

/// A segment on the way along a chain: from its first end to its second, or reversed.
struct ChainLink {
    std::uint32_t segment = 0;
    bool reversed = false;
};

/// Segments that continue each other over the surface (thesis Sec. 5.7, after Markosian et al. 1997).
struct Chain {
    std::vector<ChainLink> links;
    bool closed = false;  ///< the last link leads to the first
};

/// Joins the segments of one line type, as extract_lines has them, to chains: each segment is in exactly one. Two
/// segments of a family continue each other if they end at the two sides of an edge that no third face has, or at a
/// vertex where no third segment ends. In each chain the segment of the smallest number runs from its first end to its
/// second; a closed chain starts with it. Chains are ordered by that number, so the result depends on nothing but the
/// segments. Throws UsageError if a segment names a face that is not there.
std::vector<Chain> chain_segments(std::span<const Face> faces, std::span<const FaceNeighbors> neighbors,
                                  std::span<const LineSegment> segments);

}  // namespace exemplar
