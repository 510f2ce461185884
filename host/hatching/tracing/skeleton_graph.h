#pragma once

#include <array>
#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/mesh/mesh.h"

namespace exemplar {

constexpr int k_no_junction = -1;

/// A line of the skeleton from one junction, free end or sharp bend to the next.
struct SkeletonSegment {
    std::vector<Pixel> pixels;  ///< along the line, one at least; junctions' pixels are not among them
    std::array<int, 2> junction{k_no_junction, k_no_junction};  ///< at its front and back
    bool closed = false;                                        ///< a loop without junctions
};
/// A skeleton as its lines and where three or more of them meet.
struct SkeletonGraph {
    std::vector<SkeletonSegment> segments;
    std::vector<Vec2> junctions;  ///< their centers
};

/// The graph of a thinned mask (see thinned). Segments are cut where they bend more sharply than a circle of four
/// pixels' radius does, which is where a pen turned back.
SkeletonGraph skeleton_graph(const PixelMask& skeleton);

/// Takes away lines that end freely and are shorter than the strokes they grow from are wide: those that ragged edges
/// and square ends leave. `width` is that of strokes, per pixel.
void prune_spurs(PixelMask& skeleton, const FloatImage& width);

}  // namespace exemplar
