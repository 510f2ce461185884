#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "host/hatching/tracing/skeleton_graph.h"
#include "host/imaging/image.h"

namespace exemplar {

constexpr std::size_t k_unlinked = std::numeric_limits<std::size_t>::max();

/// An end of a segment, as a stroke leaves it: where its line is no longer bent by the junction, and the way out.
struct LooseEnd {
    Vec2 position = Vec2::Zero();
    Vec2 direction = Vec2::Zero();  ///< of length 1; zero if the segment is too short to have one
    float slack = 0;                ///< radians by which the direction may be wrong, as the segment is short
    float width = 0;                ///< of the segment's stroke
    int junction = k_no_junction;
    std::size_t trim = 0;  ///< pixels between position and the segment's last one
};

/// Which ends of segments continue each other.
struct SegmentLinks {
    std::vector<LooseEnd> ends;        ///< 2 s: the front of segment s; 2 s + 1: its back
    std::vector<std::size_t> partner;  ///< per end; k_unlinked: the stroke ends there
    std::vector<bool> shared;          ///< per segment: two strokes pass along it, and it belongs to neither
};

/// Links ends as trace_strokes says.
SegmentLinks link_segments(const SkeletonGraph& graph, const FloatImage& width, const FloatImage& darkness,
                           float faintest);

}  // namespace exemplar
