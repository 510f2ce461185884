#include "host/lines/outline_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "host/core/errors.h"
#include "host/imaging/gbuffer.h"

namespace exemplar {

namespace {

constexpr float k_edge_angle = std::numbers::pi_v<float> / 9;  // between faces that show an edge
constexpr float k_depth_jump = 2e-3f;                          // of an edge, in diagonals of the surface
constexpr float k_max_step = 10000;                            // pixels of a piece of a stroke, at most

double share(std::size_t part, std::size_t of, double if_none) {
    return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : if_none;
}

void mark_piece(const Vec2& from, const Vec2& to, InkMask& ink) {
    const float length = (to - from).norm();
    if (!(length < k_max_step)) return;
    const int steps = std::max(1, static_cast<int>(std::ceil(2 * length)));
    for (int i = 0; i <= steps; ++i) {
        const Vec2 at = from + static_cast<float>(i) / static_cast<float>(steps) * (to - from);
        const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
        if (x >= 0 && y >= 0 && x < ink.width && y < ink.height) ink.pixel(x, y)[0] = 1;
    }
}

/// Returns whether a pixel within reach of (x, y) is marked.
bool is_marked_near(const InkMask& mask, int x, int y) {
    constexpr int k_reach = k_outline_reach;
    for (int v = std::max(0, y - k_reach); v <= std::min(mask.height - 1, y + k_reach); ++v)
        for (int u = std::max(0, x - k_reach); u <= std::min(mask.width - 1, x + k_reach); ++u)
            if ((u - x) * (u - x) + (v - y) * (v - y) <= k_reach * k_reach && mask.pixel(u, v)[0]) return true;
    return false;
}

/// The surface as seen through the centers of pixels.
class SeenSurface {
  public:
    SeenSurface(const TriangleMesh& surface, const Camera& camera, int width, int height)
        : camera_(camera), surface_(surface), seen_(render_gbuffer(surface, camera, width, height)) {
        Vec3 low = Vec3::Constant(std::numeric_limits<float>::max()), high = -low;
        for (const Face& face : surface.faces)
            for (const std::uint32_t v : face) {
                low = low.cwiseMin(surface.vertices[v]);
                high = high.cwiseMax(surface.vertices[v]);
            }
        jump_ = k_depth_jump * (high - low).norm();
        normals_.reserve(surface.face_count());
        for (const auto& [a, b, c] : surface.faces)
            normals_.push_back((surface.vertices[b] - surface.vertices[a])
                                   .cross(surface.vertices[c] - surface.vertices[a])
                                   .stableNormalized());
    }

    bool shows(int x, int y) const { return face_at(x, y) != k_no_face; }
    /// Returns whether the surface shows here and not in one of the four neighbors within the picture.
    bool is_silhouette(int x, int y) const {
        if (!shows(x, y)) return false;
        return (x > 0 && !shows(x - 1, y)) || (y > 0 && !shows(x, y - 1)) ||
               (x + 1 < seen_.width && !shows(x + 1, y)) || (y + 1 < seen_.height && !shows(x, y + 1));
    }
    /// Returns whether there is an edge between two pixels.
    bool is_edge(int x, int y, int u, int v) const {
        const std::uint32_t f = face_at(x, y), g = face_at(u, v);
        if (f == g) return false;
        if (f == k_no_face || g == k_no_face) return true;
        const float angle = std::atan2(normals_[f].cross(normals_[g]).norm(), std::abs(normals_[f].dot(normals_[g])));
        return angle > k_edge_angle || jumps(x, y, u, v);
    }

  private:
    std::uint32_t face_at(int x, int y) const { return seen_.face[seen_.index(x, y)]; }
    Vec3 point_at(int x, int y) const {
        const std::size_t i = seen_.index(x, y);
        const auto& [a, b, c] = surface_.faces[seen_.face[i]];
        const auto [second, third] = seen_.barycentric[i];
        return (1 - second - third) * surface_.vertices[a] + second * surface_.vertices[b] +
               third * surface_.vertices[c];
    }
    /// Returns whether each of two points is off the plane of the other's face.
    bool jumps(int x, int y, int u, int v) const {
        const Vec3 p = point_at(x, y), way = point_at(u, v) - p;
        const float behind = std::abs(camera_.to_eye(p).dot(way));
        return behind > jump_ && std::abs(normals_[face_at(x, y)].dot(way)) > jump_ &&
               std::abs(normals_[face_at(u, v)].dot(way)) > jump_;
    }

    const Camera& camera_;
    const TriangleMesh& surface_;
    GBuffer seen_;
    std::vector<Vec3> normals_;
    float jump_ = 0;
};

InkMask edges_of(const SeenSurface& surface, int width, int height) {
    InkMask edges(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if ((x + 1 < width && surface.is_edge(x, y, x + 1, y)) ||
                (y + 1 < height && surface.is_edge(x, y, x, y + 1)))
                edges.pixel(x, y)[0] = 1;
    return edges;
}

}  // namespace

InkMask ink_of(const Drawing& drawing, std::optional<LineType> only) {
    InkMask ink(drawing.width, drawing.height, 1);
    for (const DrawingLayer& layer : drawing.layers) {
        if (only && layer.type != *only) continue;
        for (const Stroke& stroke : layer.strokes)
            for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
                if (stroke.points[i].visible) mark_piece(stroke.points[i].position, stroke.points[i + 1].position, ink);
    }
    return ink;
}

void OutlineCheck::add(const OutlineCheck& other) {
    silhouette += other.silhouette;
    outlined += other.outlined;
    contours += other.contours;
    stray += other.stray;
}

double OutlineCheck::outlined_share() const {
    return share(outlined, silhouette, 1);
}

double OutlineCheck::stray_share() const {
    return share(stray, contours, 0);
}

OutlineCheck check_outline(const TriangleMesh& surface, const Camera& camera, const InkMask& lines,
                           const InkMask& contours) {
    const int width = lines.width, height = lines.height;
    if (contours.width != width || contours.height != height)
        throw UsageError(fmt::format("ink of {} x {} and {} x {} pixels: draw both in one size", width, height,
                                     contours.width, contours.height));
    const SeenSurface seen(surface, camera, width, height);
    const InkMask edges = edges_of(seen, width, height);
    OutlineCheck check;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (seen.is_silhouette(x, y)) {
                ++check.silhouette;
                check.outlined += is_marked_near(lines, x, y) ? 1 : 0;
            }
            if (contours.pixel(x, y)[0]) {
                ++check.contours;
                check.stray += is_marked_near(edges, x, y) ? 0 : 1;
            }
        }
    return check;
}

}  // namespace exemplar
