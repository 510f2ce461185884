#include "host/lines/extraction/outline_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace exemplar {

namespace {

constexpr float k_edge_on = 1e-4f;  // sine of the angle between a face and the ray to the eye, at most

/// The direction from an edge into one of its faces, at right angles to the edge and of unit length, as the eye sees
/// it.
struct SeenFace {
    float aside = 0;   ///< to one side of the edge in the picture; near zero: seen edge-on
    float nearer = 0;  ///< towards the eye
    bool edge_on() const { return !(std::abs(aside) > k_edge_on); }
};

/// An edge with its direction to the eye.
struct SeenEdge {
    SeenEdge(const Vec3& first, const Vec3& second, const LineOptions& options)
        : origin(first), axis((second - first).stableNormalized()) {
        const Vec3 to_eye = options.to_eye(0.5f * (first + second));
        across = axis.cross(to_eye).stableNormalized();
        towards = across.cross(axis);
    }
    SeenFace see(const Vec3& opposite) const {
        Vec3 height = opposite - origin;
        height -= height.dot(axis) * axis;
        height.stableNormalize();
        return {across.dot(height), towards.dot(height)};
    }
    Vec3 origin, axis, across, towards;
};

const Vec3& corner_of(const LineSurface& surface, std::uint32_t face, std::uint32_t corner) {
    return surface.vertices[surface.faces[face][corner % 3]];
}

bool are_on_one_side(const SeenFace& a, const SeenFace& b) {
    if (a.edge_on() && b.edge_on()) return false;
    if (a.edge_on()) return a.nearer < 0;
    if (b.edge_on()) return b.nearer < 0;
    return (a.aside > 0) == (b.aside > 0);
}

/// n.w of both smooth normals along a side, linear from its first corner to its second.
struct SideFacing {
    std::array<float, 2> own{}, across{};
    bool differs(std::size_t end) const { return (own[end] > 0) != (across[end] > 0); }
};

/// Returns where a linear function with these values at 0 and 1 is zero.
float zero_of(const std::array<float, 2>& values) {
    return values[0] / (values[0] - values[1]);
}

}  // namespace

bool is_outline(const LineSurface& surface, std::uint32_t face, std::uint32_t side, const LineOptions& options) {
    const std::uint32_t across = surface.neighbors[face][side];
    if (across == k_no_neighbor) return true;
    if (!has_neighbor(across)) return false;
    const SeenEdge edge(corner_of(surface, face, side), corner_of(surface, face, side + 1), options);
    return are_on_one_side(edge.see(corner_of(surface, face, side + 2)),
                           edge.see(corner_of(surface, neighbor_face(across), neighbor_code(across) % 4 + 2)));
}

SidePart contour_along(const LineSurface& surface, std::uint32_t face, std::uint32_t side, const LineOptions& options) {
    if (is_outline(surface, face, side, options)) return {0, 1};
    const std::uint32_t other = neighbor_face(surface.neighbors[face][side]),
                        j = neighbor_code(surface.neighbors[face][side]) % 4;
    if (!oriented_alike(surface.joined_faces(), face, side, surface.neighbors[face][side])) return {};
    const auto facing = [&](std::uint32_t f, std::uint32_t corner) {
        const std::uint32_t v = surface.faces[f][corner % 3];
        return surface.normals[v].dot(options.to_eye(surface.vertices[v]));
    };
    const SideFacing at{{facing(face, side), facing(face, side + 1)}, {facing(other, j + 1), facing(other, j)}};
    const bool first = at.differs(0), second = at.differs(1);
    if (first && second) return {0, 1};
    if (!first && !second && (at.own[0] > 0) == (at.own[1] > 0)) return {};
    // One of them changes its sign, or both do.
    float low = first ? 0.0f : 1.0f, high = second ? 1.0f : 0.0f;
    for (const auto& values : {at.own, at.across}) {
        if ((values[0] > 0) == (values[1] > 0)) continue;
        const float zero = zero_of(values);
        low = std::min(low, zero);
        high = std::max(high, zero);
    }
    return {low, high};
}

}  // namespace exemplar
