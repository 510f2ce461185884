#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/strokes/chains.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// Where the texture of a chain lies: at a point that is s pixels along the chain, its coordinate is s (or -s, if it
/// runs against the chain) plus the phase of the point, but for whole periods. On the way to the next point, phases
/// change by the smaller way around.
struct ChainTexture {
    bool against = false;
    std::vector<float> phases;  ///< pixels, in [0, the texture's period); of each point, one more than there are links
};

/// See follow_traces: the largest weight of a vote (pixels), how many faces away lines are looked for, how far along
/// the chain a point goes by votes (pixels, and links), and the part of the whole chain in that.
constexpr float k_most_vote = 16;
constexpr int k_follow_faces = 8, k_follow_reach = 64, k_follow_points = 32, k_calling = 16;

/// What a segment leaves behind for the frame after.
struct LineTrace {
    std::uint32_t face = 0;
    std::uint8_t family = 0;                     ///< as LineSegment has it
    std::array<std::array<float, 3>, 2> ends{};  ///< barycentric
    std::array<float, 2> texture{};              ///< its coordinate at both ends, in pixels
};

/// The traces of the segments of a line type, in their order. Throws UsageError if sizes do not fit.
std::vector<LineTrace> trace_lines(const LineSurface& surface, std::span<const LineSegment> segments,
                                   std::span<const Chain> chains, std::span<const ChainTexture> textures,
                                   const StrokeView& view, float period);

/// Lays the textures of chains where they were in the frame before, so that they do not swim when chains grow, end
/// elsewhere or are walked the other way round (after Kalnins et al. 2003). Each link looks for a line of its family
/// in the frame before, carried along on the surface to where it is now: the nearest in the picture of those in its own
/// face, or, if there is none, of the first that there is to each side of it, within 8 faces on the way straight off
/// the line. It votes for the coordinate that the texture had there, beside its middle, and for its way, with a weight
/// of its length (16 pixels at most). The majority of the ways wins in a chain. A point's phase is the mean, on the
/// circle of the texture's period, of the winning votes within 64 pixels and 32 links to each side, the nearer counting
/// more, and to a sixteenth of those of the whole chain: so what length a chain gains or loses evens out within some
/// frames. A chain without votes begins at zero, along. `before`: traces of segments in the order of extract_lines, on
/// the same faces. Throws UsageError if the period is not positive, or as chain_segments.
std::vector<ChainTexture> follow_traces(const LineSurface& surface, std::span<const LineSegment> segments,
                                        std::span<const Chain> chains, std::span<const LineTrace> before,
                                        const StrokeView& view, float period);

/// How the drawn lines of a frame differ from those of the frame before, on the surface: what moves with it stays.
struct LineFlicker {
    float drawn = 0;     ///< pixels of length that are drawn, a faint one counting less
    float appeared = 0;  ///< the share of them that was not drawn before
    float slip = 0;      ///< pixels by which textures moved along lines that stayed: the mean
    float stretch = 0;   ///< by what share textures are longer or shorter than the lines they are on: the mean
};

}  // namespace exemplar
