#include "host/lines/strokes/chains.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include "host/core/errors.h"

namespace exemplar {

namespace {

/// An end of a segment: 2 * segment + 0 or 1.
using End = std::uint32_t;
constexpr End k_no_end = std::numeric_limits<End>::max();

/// An end at which a line may continue: its edge or vertex, and the side of the edge.
struct Junction {
    std::uint8_t family;
    bool at_vertex;
    std::uint32_t place;  ///< the vertex, or the smaller code of the edge's two sides
    std::uint32_t side;   ///< the end's own code; zero at vertices
    End end;

    auto where() const { return std::tie(family, at_vertex, place); }
    bool operator<(const Junction& other) const {
        return std::tie(family, at_vertex, place, side, end) <
               std::tie(other.family, other.at_vertex, other.place, other.side, other.end);
    }
};

void check_segments(std::span<const Face> faces, std::span<const FaceNeighbors> neighbors,
                    std::span<const LineSegment> segments) {
    if (neighbors.size() != faces.size())
        throw UsageError(fmt::format("neighbors of {} faces for {}: compute them for the same mesh", neighbors.size(),
                                     faces.size()));
    if (segments.size() >= k_no_end / 2)
        throw UsageError(fmt::format("{} segments are more than can be chained", segments.size()));
    for (std::size_t s = 0; s < segments.size(); ++s)
        if (segments[s].face >= faces.size())
            throw UsageError(fmt::format("segment {} names face {}, but there are {}: extract the lines of this mesh",
                                         s, segments[s].face, faces.size()));
}

/// Returns all ends at which lines may continue, sorted so that those at one edge or vertex are adjacent.
std::vector<Junction> sorted_junctions(std::span<const Face> faces, std::span<const FaceNeighbors> neighbors,
                                       std::span<const LineSegment> segments, bool across_sharp_edges) {
    const std::uint32_t stops = k_crowded_side | (across_sharp_edges ? 0 : k_sharp_side);
    std::vector<Junction> junctions;
    junctions.reserve(2 * segments.size());
    for (std::uint32_t s = 0; s < segments.size(); ++s)
        for (std::uint32_t e = 0; e < 2; ++e) {
            const LineSegment& segment = segments[s];
            const SegmentEnd place = segment.places[e];
            if (place >= k_inside_face) continue;
            if (place >= k_at_corner) {
                const std::uint32_t vertex = faces[segment.face][place - k_at_corner];
                junctions.push_back({segment.family, true, vertex, 0, 2 * s + e});
                continue;
            }
            const std::uint32_t own = 4 * segment.face + place, across = neighbors[segment.face][place];
            if (!has_neighbor(across) || (across & stops) != 0) continue;
            junctions.push_back({segment.family, false, std::min(own, neighbor_code(across)), own, 2 * s + e});
        }
    std::sort(junctions.begin(), junctions.end());
    return junctions;
}

/// Returns for each end the one that continues it, or k_no_end.
std::vector<End> joined_ends(std::span<const Face> faces, std::span<const FaceNeighbors> neighbors,
                             std::span<const LineSegment> segments, bool across_sharp_edges) {
    const std::vector<Junction> junctions = sorted_junctions(faces, neighbors, segments, across_sharp_edges);
    std::vector<End> joined(2 * segments.size(), k_no_end);
    for (std::size_t first = 0, last = 0; first < junctions.size(); first = last) {
        while (last < junctions.size() && junctions[last].where() == junctions[first].where()) ++last;
        if (last - first != 2) continue;
        const Junction &a = junctions[first], &b = junctions[first + 1];
        if (!a.at_vertex && a.side == b.side) continue;
        joined[a.end] = b.end;
        joined[b.end] = a.end;
    }
    return joined;
}

/// Appends the links from the segment of the end `entry`, traversed from there, until the line ends or returns to
/// the segment `stop`. Returns whether it returned.
bool follow(End entry, std::uint32_t stop, const std::vector<End>& joined, std::vector<ChainLink>& links) {
    while (true) {
        links.push_back({entry / 2, (entry & 1u) != 0});
        const End next = joined[entry ^ 1u];
        if (next == k_no_end) return false;
        if (next / 2 == stop) return true;
        entry = next;
    }
}

}  // namespace

std::vector<Chain> chain_segments(std::span<const Face> faces, std::span<const FaceNeighbors> neighbors,
                                  std::span<const LineSegment> segments, bool across_sharp_edges) {
    check_segments(faces, neighbors, segments);
    const std::vector<End> joined = joined_ends(faces, neighbors, segments, across_sharp_edges);
    std::vector<Chain> chains;
    std::vector<bool> used(segments.size(), false);
    for (std::uint32_t s = 0; s < segments.size(); ++s) {
        if (used[s]) continue;
        Chain chain;
        chain.closed = follow(2 * s, s, joined, chain.links);
        if (const End before = joined[2 * s]; !chain.closed && before != k_no_end) {
            std::vector<ChainLink> back;
            follow(before, s, joined, back);
            for (ChainLink& link : back) link.reversed = !link.reversed;
            chain.links.insert(chain.links.begin(), back.rbegin(), back.rend());
        }
        for (const ChainLink& link : chain.links) used[link.segment] = true;
        chains.push_back(std::move(chain));
    }
    return chains;
}

}  // namespace exemplar
