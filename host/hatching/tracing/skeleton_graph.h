#pragma once

#include <array>
#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/mesh/mesh.h"

namespace exemplar {

constexpr int k_no_junction = -1;

/// A line of the skeleton between junctions, free ends or sharp bends.
struct SkeletonSegment {
    std::vector<Pixel> pixels;  ///< along the line, at least one; without the pixels of junctions
    std::array<int, 2> junction{k_no_junction, k_no_junction};  ///< at its front and back
    bool closed = false;                                        ///< a loop without junctions
};
/// A skeleton: its lines, and the junctions where three or more of them meet.
struct SkeletonGraph {
    std::vector<SkeletonSegment> segments;
    std::vector<Vec2> junctions;  ///< their centers
};

/// Returns the graph of a thinned mask (see thinned). Segments are cut where they bend more sharply than a circle
/// with a radius of four pixels, as a pen turned back there.
SkeletonGraph skeleton_graph(const PixelMask& skeleton);

/// Removes spurs, which ragged edges and square ends leave: lines with a free end that are shorter than the width of
/// the stroke they branch from. `width`: of strokes, per pixel.
void prune_spurs(PixelMask& skeleton, const FloatImage& width);

}  // namespace exemplar
