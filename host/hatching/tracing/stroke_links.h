#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "host/hatching/tracing/skeleton_graph.h"
#include "host/imaging/image.h"

namespace exemplar {

constexpr std::size_t k_unlinked = std::numeric_limits<std::size_t>::max();

/// An end of a segment: the point where the junction no longer bends its line, and the direction out of the segment.
struct SkeletonEnd {
    Vec2 position = Vec2::Zero();
    Vec2 direction = Vec2::Zero();  ///< unit, outwards; zero if the segment is too short to have one
    float slack = 0;                ///< possible error of the direction, radians; larger for short segments
    float width = 0;                ///< of the segment's stroke
    int junction = k_no_junction;
    std::size_t trim = 0;  ///< pixels between position and the segment's last one
};

/// Pairs of segment ends that continue each other.
struct SegmentLinks {
    std::vector<SkeletonEnd> ends;     ///< 2 s: the front of segment s; 2 s + 1: its back
    std::vector<std::size_t> partner;  ///< per end; k_unlinked: the stroke ends there
    std::vector<bool> shared;          ///< per segment: two strokes pass along it, and it belongs to neither
};

/// Links the ends of segments by the rules of trace_strokes().
SegmentLinks link_segments(const SkeletonGraph& graph, const FloatImage& width, const FloatImage& darkness,
                           float min_darkness);

}  // namespace exemplar
