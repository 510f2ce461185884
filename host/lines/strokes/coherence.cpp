#include "host/lines/strokes/coherence.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr float k_nowhere = std::numeric_limits<float>::max();

Vec3 on_face(const LineSurface& surface, std::uint32_t face, const std::array<float, 3>& weights) {
    Vec3 at = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) at += weights[i] * surface.vertices[surface.faces[face][i]];
    return at;
}

Vec2 in_picture(const StrokeView& view, const Vec3& at) {
    return view.camera.project(at, view.width, view.height).head<2>();
}

/// A trace projected into the current picture.
struct SeenTrace {
    std::uint32_t face;
    std::uint8_t family;
    std::array<Vec2, 2> ends;
    std::array<float, 2> texture;
};

std::vector<SeenTrace> seen_traces(const LineSurface& surface, std::span<const LineTrace> traces,
                                   const StrokeView& view) {
    std::vector<SeenTrace> seen;
    for (const LineTrace& trace : traces) {
        SeenTrace now{trace.face, trace.family, {}, trace.texture};
        bool in_front = true;
        for (std::size_t end = 0; end < 2; ++end) {
            const Vec3 at = on_face(surface, trace.face, trace.ends[end]);
            in_front &= (view.camera.view_projection() * at.homogeneous()).w() > 0;
            now.ends[end] = in_picture(view, at);
        }
        if (in_front) seen.push_back(now);
    }
    return seen;
}

/// The line of the previous frame nearest to a piece of a chain.
struct Match {
    float away = k_nowhere;  ///< pixels
    float texture = 0;
    bool along = true;
};

/// A link in the picture: its segment, middle and vector.
struct TracePiece {
    const LineSegment& segment;
    Vec2 middle, way;
};

class TraceFinder {
  public:
    TraceFinder(const LineSurface& surface, std::vector<SeenTrace> seen) : surface_(surface), seen_(std::move(seen)) {}

    Match find(const TracePiece& piece) const {
        Match best;
        look_in(piece.segment.face, piece, best);
        if (best.away == k_nowhere) look_beside(piece, best);
        return best;
    }

  private:
    void look_in(std::uint32_t face, const TracePiece& piece, Match& best) const {
        const auto by_face = [](const SeenTrace& a, std::uint32_t b) { return a.face < b; };
        for (auto i = std::lower_bound(seen_.begin(), seen_.end(), face, by_face); i != seen_.end() && i->face == face;
             ++i)
            if (i->family == piece.segment.family) compare(*i, piece, best);
    }

    static void compare(const SeenTrace& trace, const TracePiece& piece, Match& best) {
        const Vec2 on = trace.ends[1] - trace.ends[0];
        const float squared = on.squaredNorm();
        // Texture coordinates are extrapolated by up to its length beyond its ends.
        const float t = squared > 0 ? std::clamp((piece.middle - trace.ends[0]).dot(on) / squared, -1.0f, 2.0f) : 0.5f;
        const float away = (piece.middle - trace.ends[0] - std::clamp(t, 0.0f, 1.0f) * on).norm();
        if (away >= best.away) return;
        best = {away, trace.texture[0] + t * (trace.texture[1] - trace.texture[0]),
                on.dot(piece.way) * (trace.texture[1] - trace.texture[0]) >= 0};
    }

    void look_beside(const TracePiece& piece, Match& best) const {
        const LineSegment& segment = piece.segment;
        const Face& face = surface_.faces[segment.face];
        const Vec3 a = surface_.vertices[face[0]], b = surface_.vertices[face[1]], c = surface_.vertices[face[2]];
        const Vec3 on =
            on_face(surface_, segment.face, segment.ends[1]) - on_face(surface_, segment.face, segment.ends[0]);
        const Vec3 off = (b - a).cross(c - a).cross(on);
        for (const float side : {-1.0f, 1.0f}) {
            Match found;
            std::optional<std::uint32_t> at = segment.face;
            for (int i = 0; i < k_follow_faces && found.away == k_nowhere; ++i) {
                at = face_towards(*at, side * off);
                if (!at) break;
                look_in(*at, piece, found);
            }
            if (found.away < best.away) best = found;
        }
    }

    /// Returns the neighbor in a direction: across the side opposite to the corner that lies farthest back.
    std::optional<std::uint32_t> face_towards(std::uint32_t face, const Vec3& way) const {
        std::array<float, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i] = surface_.vertices[surface_.faces[face][i]].dot(way);
        const auto back = static_cast<std::size_t>(std::min_element(at.begin(), at.end()) - at.begin());
        const std::uint32_t across = surface_.neighbors[face][(back + 1) % 3];
        if (across > k_max_neighbor_code) return std::nullopt;
        return across / 4;
    }

    const LineSurface& surface_;
    std::vector<SeenTrace> seen_;
};

constexpr float k_turn = 2 * std::numbers::pi_v<float>;

/// The vote of a link: the phase of the texture at the chain's start as an angle, in a vector with the weight as
/// length.
struct Vote {
    Vec2 turn = Vec2::Zero();
    bool along = true;
    float at = 0;  ///< pixels along the chain
};

Vote vote_of(const Match& match, float at, float size, float period) {
    if (match.away == k_nowhere) return {.at = at};
    const float begin = (match.texture + (match.along ? -at : at)) / period;
    const float angle = k_turn * (begin - std::floor(begin));
    return {std::min(size, k_max_vote) * Vec2(std::cos(angle), std::sin(angle)), match.along, at};
}

/// A link of a chain in the picture.
struct PictureLink {
    const LineSegment& segment;
    bool reversed;
    Vec2 begin, end;
    float along;  ///< pixels, at its begin

    float size() const { return (end - begin).norm(); }
};

std::vector<PictureLink> picture_links(const LineSurface& surface, std::span<const LineSegment> segments,
                                       const Chain& chain, const StrokeView& view) {
    std::vector<PictureLink> links;
    float along = 0;
    for (const auto& [number, reversed] : chain.links) {
        const LineSegment& segment = segments[number];
        const auto end = [&](bool second) {
            return in_picture(view, on_face(surface, segment.face, segment.ends[second ? 1 : 0]));
        };
        links.push_back({segment, reversed, end(reversed), end(!reversed), along});
        along += links.back().size();
    }
    return links;
}

/// Returns the sum of the votes for a direction around a point, over links before and after it.
Vec2 votes_around(const std::vector<Vote>& votes, bool along, std::size_t point, float at) {
    Vec2 sum = Vec2::Zero();
    const auto add_side = [&](auto begin, auto end) {
        for (int i = 0; i < k_follow_points && begin != end; ++i, ++begin) {
            const float near = 1 - std::abs(begin->at - at) / k_follow_reach;
            if (!(near > 0)) return;
            if (begin->along == along) sum += near * begin->turn;
        }
    };
    add_side(votes.begin() + static_cast<std::ptrdiff_t>(point), votes.end());
    add_side(votes.rend() - static_cast<std::ptrdiff_t>(point), votes.rend());
    return sum;
}

ChainTexture laid_by(const std::vector<Vote>& votes, const std::vector<PictureLink>& links, float period) {
    ChainTexture texture{false, std::vector<float>(links.size() + 1, 0)};
    float balance = 0;
    for (const Vote& vote : votes) balance += vote.along ? vote.turn.norm() : -vote.turn.norm();
    const bool runs_along = balance >= 0;
    Vec2 all = Vec2::Zero();
    for (const Vote& vote : votes)
        if (vote.along == runs_along) all += vote.turn;
    if (all == Vec2::Zero()) return texture;
    texture.against = !runs_along;
    for (std::size_t i = 0; i <= links.size(); ++i) {
        const float at = i < links.size() ? links[i].along : links.back().along + links.back().size();
        const Vec2 around = votes_around(votes, runs_along, i, at);
        Vec2 turn = all.normalized();
        if (around != Vec2::Zero()) turn += (k_whole_chain_divisor - 1) * around.normalized();
        const float turns = std::atan2(turn.y(), turn.x()) / k_turn;
        texture.phases[i] = period * (turns - std::floor(turns));
    }
    return texture;
}

void check_traces(const LineSurface& surface, std::span<const LineTrace> traces) {
    if (surface.neighbors.size() != surface.faces.size())
        throw UsageError(fmt::format("neighbors of {} faces for {}: compute them for the same mesh",
                                     surface.neighbors.size(), surface.faces.size()));
    for (std::size_t i = 0; i < traces.size(); ++i)
        if (traces[i].face >= surface.faces.size() || (i > 0 && traces[i].face < traces[i - 1].face))
            throw UsageError(
                fmt::format("trace {} is of face {}: give traces of this mesh, ordered by face", i, traces[i].face));
}

}  // namespace

std::vector<LineTrace> trace_lines(const LineSurface& surface, std::span<const LineSegment> segments,
                                   std::span<const Chain> chains, std::span<const ChainTexture> textures,
                                   const StrokeView& view, float period) {
    if (textures.size() != chains.size())
        throw UsageError(
            fmt::format("textures of {} chains for {}; lay them on the same chains", textures.size(), chains.size()));
    std::vector<LineTrace> traces;
    for (const LineSegment& segment : segments) traces.push_back({segment.face, segment.family, segment.ends, {}});
    for (std::size_t i = 0; i < chains.size(); ++i) {
        const ChainTexture& texture = textures[i];
        const std::vector<PictureLink> links = picture_links(surface, segments, chains[i], view);
        const float way = texture.against ? -1.0f : 1.0f;
        for (std::size_t k = 0; k < links.size(); ++k) {
            const float turn = (texture.phases[k + 1] - texture.phases[k]) / period;
            const float begin = texture.phases[k] + way * links[k].along;
            const float end = begin + way * links[k].size() + period * (turn - std::round(turn));
            traces[chains[i].links[k].segment].texture =
                links[k].reversed ? std::array{end, begin} : std::array{begin, end};
        }
    }
    return traces;
}

std::vector<ChainTexture> follow_traces(const LineSurface& surface, std::span<const LineSegment> segments,
                                        std::span<const Chain> chains, std::span<const LineTrace> before,
                                        const StrokeView& view, float period) {
    if (!(period > 0)) throw UsageError(fmt::format("a texture of {} pixels; give a positive length", period));
    check_traces(surface, before);
    const TraceFinder finder(surface, seen_traces(surface, before, view));
    std::vector<ChainTexture> textures;
    for (const Chain& chain : chains) {
        const std::vector<PictureLink> links = picture_links(surface, segments, chain, view);
        std::vector<Vote> votes;
        for (const PictureLink& link : links) {
            const Match match = finder.find({link.segment, 0.5f * (link.begin + link.end), link.end - link.begin});
            votes.push_back(vote_of(match, link.along + 0.5f * link.size(), link.size(), period));
        }
        textures.push_back(laid_by(votes, links, period));
    }
    return textures;
}

}  // namespace exemplar
