#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "host/lines/strokes/chains.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// Placement of the texture on a chain. At a point at arc length s (pixels) its coordinate is s, or -s if it runs
/// against the chain, plus the phase of the point, modulo the period. Between points, phases change by the shorter
/// way around the period.
struct ChainTexture {
    bool against = false;
    std::vector<float> phases;  ///< per point (links + 1): pixels in [0, period of the texture)
};

/// Parameters of follow_traces: maximum weight of a vote (pixels), number of faces searched to each side, reach of
/// votes along the chain (pixels, and links), and the inverse share of the whole chain's mean.
constexpr float k_max_vote = 16;
constexpr int k_follow_faces = 8, k_follow_reach = 64, k_follow_points = 32, k_whole_chain_divisor = 16;

/// The data of a segment that the next frame needs.
struct LineTrace {
    std::uint32_t face = 0;
    std::uint8_t family = 0;                     ///< as in LineSegment
    std::array<std::array<float, 3>, 2> ends{};  ///< barycentric
    std::array<float, 2> texture{};              ///< texture coordinates at both ends, in pixels
};

/// Returns the traces of the segments of a line type, in their order. Throws UsageError if sizes do not fit.
std::vector<LineTrace> trace_lines(const LineSurface& surface, std::span<const LineSegment> segments,
                                   std::span<const Chain> chains, std::span<const ChainTexture> textures,
                                   const StrokeView& view, float period);

/// Places the textures of chains where they were in the previous frame, so that they do not swim when chains grow,
/// end elsewhere or change direction (after Kalnins et al. 2003).
/// (1) Each link searches the nearest previous line of its family, moved along with the surface: in its own face or
/// else, on each side perpendicular to the line, in the first of up to 8 faces that has one. (2) It votes for the
/// texture's coordinate and direction there, weighted by its length in pixels, at most 16. (3) In a chain the
/// majority direction wins. (4) The phase of a point is the circular mean over the period of the winning votes
/// within 64 pixels and 32 links to each side, nearer ones weighing more, blended with 1/16 of the mean of the whole
/// chain, so that changes of length even out within some frames. Without votes the texture starts at zero and runs
/// along the chain. `before`: traces of segments in the order of extract_lines, on the same faces. Throws UsageError
/// if the period is not positive, the traces are not ordered by face, or neighbors are not those of the faces.
std::vector<ChainTexture> follow_traces(const LineSurface& surface, std::span<const LineSegment> segments,
                                        std::span<const Chain> chains, std::span<const LineTrace> before,
                                        const StrokeView& view, float period);

/// How the drawn lines of a frame differ from those of the previous frame moved along with the surface.
struct LineFlicker {
    float drawn = 0;     ///< drawn length in pixels, weighted by opacity
    float appeared = 0;  ///< share of it that was not drawn before
    float slip = 0;      ///< mean movement of textures along persisting lines, in pixels
    float stretch = 0;   ///< mean share by which textures are longer or shorter than their lines
};

}  // namespace exemplar
