#include "host/lines/strokes/visibility.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {

namespace {

constexpr std::size_t k_segment_grain = 64;  // segments that one thread takes at a time
// Reach of ignored nearby faces: in edges of the point's face, and at most in distances of its corners from the line
// (over the sine of its angle with the ray to the eye), so that long faces reach less far beside a line along them.
constexpr float k_near_edges = 3, k_near_asides = 8;
constexpr float k_touching_edges = 1e-3f;    // the same for faces that touch the point's face, for any line
constexpr float k_precision = 0.05f;         // precision of changes of visibility, in pixels
constexpr std::size_t k_max_samples = 4096;  // of one segment
constexpr float k_same_pixels = 0.01f;       // points of a chain closer than this are one
constexpr int k_max_hits = 64;               // ignored hits of one ray, at most
constexpr float k_inward_pixels = 0.2f;      // from an edge to the point that stands for it, in a face at the edge
constexpr float k_max_inward = 0.1f;         // the same, in heights of the face
constexpr float k_least_cosine = 1e-3f;      // between a normal and the ray to the eye; less is seen edge-on

TriangleMesh mesh_of(const LineSurface& surface) {
    TriangleMesh mesh;
    mesh.vertices.assign(surface.vertices.begin(), surface.vertices.end());
    mesh.faces.assign(surface.faces.begin(), surface.faces.end());
    return mesh;
}

const LineSurface& checked(const LineSurface& surface) {
    if (surface.normals.size() != surface.vertices.size())
        throw UsageError(fmt::format("{} normals for {} vertices: compute them for the same mesh",
                                     surface.normals.size(), surface.vertices.size()));
    return surface;
}

/// Returns for each face whether its edge-connected component has no boundary.
std::vector<std::uint8_t> closed_components(std::span<const FaceNeighbors> neighbors) {
    DisjointSets sets(neighbors.size());
    for (std::uint32_t f = 0; f < neighbors.size(); ++f)
        for (const std::uint32_t across : neighbors[f])
            if (has_neighbor(across)) sets.join(f, neighbor_face(across));
    std::vector<std::uint8_t> closed_set(neighbors.size(), 1), closed(neighbors.size());
    for (std::uint32_t f = 0; f < neighbors.size(); ++f)
        for (const std::uint32_t across : neighbors[f])
            if (across == k_no_neighbor) closed_set[sets.find(f)] = 0;
    for (std::uint32_t f = 0; f < neighbors.size(); ++f) closed[f] = closed_set[sets.find(f)];
    return closed;
}

}  // namespace

LineVisibility::LineVisibility(const LineSurface& surface)
    : surface_(checked(surface)), rays_(mesh_of(surface)), vertex_begin_(surface.vertices.size() + 1, 0) {
    closed_ = surface.neighbors.size() == surface.faces.size()
                  ? closed_components(surface.neighbors)
                  : closed_components(build_face_neighbors(surface.faces, surface.vertices));
    const std::span<const Face> faces = surface.joined_faces();
    for (const Face& face : faces)
        for (const std::uint32_t v : face) ++vertex_begin_[v + 1];
    for (std::size_t v = 1; v < vertex_begin_.size(); ++v) vertex_begin_[v] += vertex_begin_[v - 1];
    vertex_faces_.resize(3 * surface.faces.size());
    std::vector<std::uint32_t> next = vertex_begin_;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (const std::uint32_t v : faces[f]) vertex_faces_[next[v]++] = f;
    float largest = 0;
    for (const Vec3& p : surface.vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    rounding_ = 8 * std::numeric_limits<float>::epsilon() * largest;
}

bool LineVisibility::touch(std::uint32_t face, std::uint32_t other) const {
    for (const std::uint32_t a : surface_.joined_faces()[face])
        for (const std::uint32_t b : surface_.joined_faces()[other])
            if (a == b) return true;
    return false;
}

bool LineVisibility::are_near(std::uint32_t face, std::uint32_t other) const {
    for (const std::uint32_t v : surface_.joined_faces()[other])
        for (const std::uint32_t between : faces_at(v))
            if (touch(face, between)) return true;
    return false;
}

/// Tests points of one segment for visibility from one camera.
class LineVisibility::Query {
  public:
    Query(const LineVisibility& scene, LineType type, const LineSegment& segment, const Camera& camera,
          const Eigen::Matrix4f& matrix, int width, int height, const VisibilityOptions& options)
        : scene_(scene),
          segment_(segment),
          camera_(camera),
          matrix_(matrix),
          half_size_(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height)),
          face_(scene.surface_.faces[segment.face]) {
        room_ = {1 + 2 * options.margin / static_cast<float>(width),
                 1 + 2 * options.margin / static_cast<float>(height)};
        const auto corner = [&](std::size_t i) -> const Vec3& { return scene.surface_.vertices[face_[i]]; };
        cross_ = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        for (std::size_t i = 0; i < 3; ++i) longest_ = std::max(longest_, (corner((i + 1) % 3) - corner(i)).norm());
        near_ = std::min(k_near_edges * longest_, reach_aside(face_));
        edge_ = runs_along_edge(type, segment);
        contour_ = type == LineType::contours && !edge_;
        contour_bends_away_ = contour_ && bends_away();
        if (edge_) find_faces_at_edge(type == LineType::contours);
    }

    /// Returns the point at t from the first end (0) to the second (1).
    Vec3 point(float t) const {
        Vec3 p = Vec3::Zero();
        for (std::size_t i = 0; i < 3; ++i) p += weight(i, t) * scene_.surface_.vertices[face_[i]];
        return p;
    }
    bool visible(float t) const {
        const Vec3 p = point(t);
        const Eigen::Vector4f clip = matrix_ * p.homogeneous();
        const float w = clip.w();
        if (!(w > 0 && clip.z() >= 0 && clip.z() <= w)) return false;
        if (std::abs(clip.x()) > w * room_.x() || std::abs(clip.y()) > w * room_.y()) return false;
        if (edge_) return is_edge_visible(p) || (turns_away_ && !hidden(p, segment_.face, true));
        return !hidden(p, segment_.face, overlooks_near_faces(camera_.to_eye(p), t));
    }

  private:
    /// A face at the edge that the segment runs along, and its corner that is not on the edge.
    struct FaceAtEdge {
        std::uint32_t face, opposite;
    };
    /// Finds the faces that stand for an edge: those at it that are not seen edge-on. `smooth`: whether the edge may be
    /// a contour by its smooth normals alone, while the polygons at it turn away already.
    void find_faces_at_edge(bool smooth) {
        std::uint32_t opposite = 0;
        while (opposite < 2 && (segment_.ends[0][opposite] != 0 || segment_.ends[1][opposite] != 0)) ++opposite;
        const float cosine = add_face_at_edge(segment_.face, opposite);
        if (scene_.surface_.neighbors.empty()) return;
        const std::uint32_t across = scene_.surface_.neighbors[segment_.face][(opposite + 1) % 3];
        if (!has_neighbor(across)) return;
        const std::uint32_t other = neighbor_face(across), corner = (neighbor_code(across) % 4 + 2) % 3;
        const float other_cosine = add_face_at_edge(other, corner);
        const Face& corners = scene_.surface_.faces[other];
        const bool convex = cross_.dot(scene_.surface_.vertices[corners[corner]] - point(0.5f)) < 0;
        turns_away_ = smooth && convex && std::max(cosine, other_cosine) < k_least_cosine;
        near_ = std::min(near_, reach_aside(corners));
    }
    /// Returns the cosine between its normal and the ray to the eye.
    float add_face_at_edge(std::uint32_t face, std::uint32_t opposite) {
        const Face& corners = scene_.surface_.faces[face];
        const auto at = [&](std::uint32_t i) -> const Vec3& { return scene_.surface_.vertices[corners[i]]; };
        const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0)).stableNormalized();
        const float cosine = normal.dot(camera_.to_eye(point(0.5f)));
        if (std::abs(cosine) > k_least_cosine) at_edge_[at_edge_count_++] = {face, corners[opposite]};
        return cosine;
    }
    /// Returns whether a face at the edge is visible close to a point of it. The point itself may lie exactly in front
    /// of or behind others, as all edges of a box do that is seen from the front.
    bool is_edge_visible(const Vec3& p) const {
        for (std::size_t i = 0; i < at_edge_count_; ++i) {
            const Vec3 inward = scene_.surface_.vertices[at_edge_[i].opposite] - p;
            const float pixels = (in_picture(p + k_max_inward * inward) - in_picture(p)).norm() / k_max_inward;
            const float share = pixels > 0 ? std::min(k_max_inward, k_inward_pixels / pixels) : k_max_inward;
            if (!hidden(p + share * inward, at_edge_[i].face, false)) return true;
        }
        return false;
    }
    Vec2 in_picture(const Vec3& p) const {
        const Eigen::Vector4f clip = matrix_ * p.homogeneous();
        return (clip.head<2>() / clip.w()).cwiseProduct(half_size_);
    }
    float weight(std::size_t corner, float t) const {
        const float a = segment_.ends[0][corner], b = segment_.ends[1][corner];
        return a + t * (b - a);
    }
    /// Returns whether the surface at a contour bends away from the ray to the eye, i.e. radial curvature is
    /// positive, so that it does not hide the contour. Measured curvature is more reliable here than a face's
    /// normals, but for faces at sharp edges, where it may be that of the edge.
    bool bends_away() const {
        const VertexCurvature& c = scene_.surface_.curvature;
        if (c.k1.size() != scene_.surface_.vertices.size() || is_at_sharp_edge()) return grows_to_eye();
        float bend = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t v = face_[i];
            const Vec3 to_eye = camera_.to_eye(scene_.surface_.vertices[v]);
            const float along_1 = c.e1[v].dot(to_eye), along_2 = c.e2[v].dot(to_eye);
            bend += weight(i, 0.5f) * (c.k1[v] * along_1 * along_1 + c.k2[v] * along_2 * along_2);
        }
        return bend > 0;
    }
    bool is_at_sharp_edge() const {
        return !scene_.surface_.neighbors.empty() &&
               std::ranges::any_of(scene_.surface_.neighbors[segment_.face], [](std::uint32_t across) {
                   return has_neighbor(across) && (across & k_sharp_side) != 0;
               });
    }
    /// Returns the same without curvature: whether n.w, which is linear in the face, grows towards the eye.
    bool grows_to_eye() const {
        // Its gradient, times the squared length of the cross product, which is positive.
        Vec3 gradient = Vec3::Zero();
        const auto& surface = scene_.surface_;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 &a = surface.vertices[face_[(i + 1) % 3]], &b = surface.vertices[face_[(i + 2) % 3]];
            const Vec3& p = surface.vertices[face_[i]];
            gradient += surface.normals[face_[i]].dot(camera_.to_eye(p)) * cross_.cross(b - a);
        }
        return gradient.dot(camera_.to_eye(point(0.5f))) > 0;
    }
    /// Returns whether nearby faces may lie in front of the point without hiding it; see visible_parts.
    bool overlooks_near_faces(const Vec3& to_eye, float t) const {
        if (contour_) return contour_bends_away_ || !scene_.closed_[segment_.face];
        float cosine = 0;
        for (std::size_t i = 0; i < 3; ++i) cosine += weight(i, t) * scene_.surface_.normals[face_[i]].dot(to_eye);
        return cosine > 0 && !(cross_.dot(to_eye) > 0);
    }
    /// Returns whether something is in front of a point of a face.
    bool hidden(const Vec3& p, std::uint32_t face, bool overlooks) const {
        const Vec3 to_eye = camera_.to_eye(p);
        // Hits in front of the near plane do not count.
        const float to_near_plane = depth_from_near(p) / std::max(1e-6f, to_eye.dot(backward()));
        float near = scene_.rounding_;
        bool behind_other = false;  // which is hidden itself if a face follows that is overlooked
        for (int hits = 0; hits < k_max_hits; ++hits) {
            const auto hit = scene_.rays_.first_hit(p, to_eye, near);
            if (!hit || hit->distance > to_near_plane) return behind_other;
            const bool overlooked = is_overlooked(*hit, face, overlooks);
            if (!overlooked && !(overlooks && hit->distance <= near_)) return true;
            behind_other = !overlooked;
            near = hit->distance + std::max(scene_.rounding_, hit->distance * 1e-6f);
        }
        return true;
    }
    bool is_overlooked(const RayScene::Hit& hit, std::uint32_t face, bool overlooks) const {
        if (hit.face == face) return true;
        if (hit.distance > near_) return false;
        if (hit.distance <= k_touching_edges * longest_ && scene_.touch(face, hit.face)) return true;
        return overlooks && scene_.are_near(face, hit.face);
    }
    /// Returns how far nearby faces may be ignored beside the line, by the distances of the corners of a face from it.
    float reach_aside(const Face& face) const {
        const Vec3 from = point(0), along = (point(1) - from).stableNormalized();
        const float slant = along.cross(camera_.to_eye(from)).norm();
        float largest = 0;
        for (const std::uint32_t v : face) {
            const Vec3 corner = scene_.surface_.vertices[v] - from;
            largest = std::max(largest, (corner - corner.dot(along) * along).norm());
        }
        return k_near_asides * largest / std::max(slant, 1e-3f);
    }
    Vec3 backward() const { return camera_.view.block<1, 3>(2, 0).transpose(); }
    /// Returns the distance from the near plane to the point along the camera's axis.
    float depth_from_near(const Vec3& p) const {
        const Eigen::Matrix4f& projection = camera_.projection;
        return -backward().dot(p) - camera_.view(2, 3) - projection(2, 3) / projection(2, 2);
    }

    const LineVisibility& scene_;
    const LineSegment& segment_;
    const Camera& camera_;
    const Eigen::Matrix4f& matrix_;
    Vec2 half_size_;
    const Face& face_;
    Vec2 room_;
    Vec3 cross_;
    float longest_ = 0;  // edge of the face
    float near_ = 0;     // distance up to which nearby faces may be ignored
    bool edge_ = false, turns_away_ = false, contour_ = false, contour_bends_away_ = false;
    std::array<FaceAtEdge, 2> at_edge_{};
    std::size_t at_edge_count_ = 0;
};

namespace {

VisiblePart turned(const VisiblePart& part, bool reversed) {
    return reversed ? VisiblePart{1 - part.to, 1 - part.from} : part;
}

VisibleParts joined(const std::vector<std::vector<VisiblePart>>& parts) {
    VisibleParts result;
    for (const std::vector<VisiblePart>& of_segment : parts) {
        result.parts.insert(result.parts.end(), of_segment.begin(), of_segment.end());
        result.begin.push_back(static_cast<std::uint32_t>(result.parts.size()));
    }
    return result;
}

/// Returns the visible spans along a chain, in pixels from its start, with short gaps closed.
std::vector<VisiblePart> spans_without_gaps(const Chain& chain, float max_pixels, const VisibleParts& visible) {
    std::vector<VisiblePart> spans;
    float start = 0;
    for (const ChainLink& link : chain.links) {
        const float length = visible.pixels[link.segment];
        const std::span<const VisiblePart> own = visible.of(link.segment);
        for (std::size_t i = 0; i < own.size(); ++i) {
            const VisiblePart part = turned(own[link.reversed ? own.size() - 1 - i : i], link.reversed);
            const float from = start + part.from * length, to = start + part.to * length;
            if (!spans.empty() && from - spans.back().to <= max_pixels)
                spans.back().to = to;
            else
                spans.push_back({from, to});
        }
        start += length;
    }
    if (chain.closed && !spans.empty() && start - spans.back().to + spans.front().from <= max_pixels) {
        spans.front().from = 0;
        spans.back().to = start;
    }
    return spans;
}

/// Cuts spans along a chain into the parts of its segments.
void cut_to_segments(const Chain& chain, std::span<const float> pixels, const std::vector<VisiblePart>& spans,
                     std::vector<std::vector<VisiblePart>>& parts) {
    float start = 0;
    std::size_t first = 0;
    for (const ChainLink& link : chain.links) {
        const float length = pixels[link.segment], end = start + length;
        while (first < spans.size() && spans[first].to < start) ++first;
        std::vector<VisiblePart> cut;
        if (!(length > 0)) {  // a point, which must not interrupt a span
            if (first < spans.size() && spans[first].from <= start) parts[link.segment] = {{0, 1}};
            continue;
        }
        for (std::size_t i = first; i < spans.size() && spans[i].from < end; ++i) {
            // Ends of spans at ends of segments are snapped to them, so that rounding does not open gaps.
            const float from = spans[i].from - k_same_pixels < start ? 0 : (spans[i].from - start) / length;
            const float to = spans[i].to + k_same_pixels > end ? 1 : (spans[i].to - start) / length;
            const VisiblePart part{std::min(from, 1.0f), std::max(to, 0.0f)};
            if (part.from < part.to) cut.push_back(turned(part, link.reversed));
        }
        if (link.reversed) std::reverse(cut.begin(), cut.end());
        parts[link.segment] = std::move(cut);
        start = end;
    }
}

/// Finds where visibility changes between a and b, of which exactly one is visible, by bisection.
template <typename Visible>
float change_between(float a, float b, bool visible_at_a, float precision, const Visible& visible) {
    while (b - a > precision) {
        const float middle = 0.5f * (a + b);
        if (!(middle > a && middle < b)) break;
        (visible(middle) == visible_at_a ? a : b) = middle;
    }
    return 0.5f * (a + b);
}

/// Appends the visible parts of a segment with a length of `pixels`.
template <typename Visible>
void add_parts(float pixels, float spacing, const Visible& visible, std::vector<VisiblePart>& parts) {
    const float wanted = std::ceil(std::min(pixels / spacing, static_cast<float>(k_max_samples)));
    const std::size_t count = std::max<std::size_t>(1, static_cast<std::size_t>(wanted));
    const float step = 1 / static_cast<float>(count), precision = k_precision / std::max(pixels, k_precision);
    bool before = visible(0.5f * step);
    if (before) parts.push_back({0, 1});
    for (std::size_t i = 1; i < count; ++i) {
        const float t = (static_cast<float>(i) + 0.5f) * step;
        const bool now = visible(t);
        if (now == before) continue;
        const float change = change_between(t - step, t, before, precision, visible);
        if (now)
            parts.push_back({change, 1});
        else
            parts.back().to = change;
        before = now;
    }
}

}  // namespace

VisibleParts LineVisibility::visible_parts(LineType type, std::span<const LineSegment> segments, const Camera& camera,
                                           int width, int height, const VisibilityOptions& options) const {
    if (!(options.spacing > 0 && options.margin >= 0) || width <= 0 || height <= 0)
        throw UsageError(fmt::format("a picture of {} x {} pixels, tested every {} pixels: give positive numbers",
                                     width, height, options.spacing));
    for (std::size_t s = 0; s < segments.size(); ++s)
        if (segments[s].face >= surface_.faces.size())
            throw UsageError(fmt::format("segment {} names face {}, but there are {}: extract the lines of this mesh",
                                         s, segments[s].face, surface_.faces.size()));
    const Eigen::Matrix4f matrix = camera.view_projection();
    const Vec2 half_size(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height));
    std::vector<std::vector<VisiblePart>> parts(segments.size());
    std::vector<float> lengths(segments.size(), 0);
    parallel_for(
        segments.size(),
        [&](std::size_t s) {
            const Query query(*this, type, segments[s], camera, matrix, width, height, options);
            const Eigen::Vector4f a = matrix * query.point(0).homogeneous(), b = matrix * query.point(1).homogeneous();
            float pixels = std::numeric_limits<float>::max();  // of segments that reach behind the eye
            if (a.w() > 0 && b.w() > 0)
                pixels = (a.head<2>() / a.w() - b.head<2>() / b.w()).cwiseProduct(half_size).norm();
            if (!std::isfinite(pixels)) pixels = 0;
            if (pixels < std::numeric_limits<float>::max()) lengths[s] = pixels;
            add_parts(
                pixels, options.spacing, [&](float t) { return query.visible(t); }, parts[s]);
        },
        k_segment_grain);
    VisibleParts result = joined(parts);
    result.pixels = std::move(lengths);
    return result;
}

void close_gaps(std::span<const Chain> chains, float max_pixels, VisibleParts& visible) {
    const std::size_t count = visible.segment_count();
    if (visible.pixels.size() != count)
        throw UsageError(
            fmt::format("lengths of {} segments for the visible parts of {}", visible.pixels.size(), count));
    std::vector<std::vector<VisiblePart>> parts(count);
    for (std::size_t s = 0; s < count; ++s) parts[s].assign(visible.of(s).begin(), visible.of(s).end());
    for (const Chain& chain : chains) {
        for (const ChainLink& link : chain.links)
            if (link.segment >= count)
                throw UsageError(fmt::format("a chain names segment {}, but there are {}", link.segment, count));
        cut_to_segments(chain, visible.pixels, spans_without_gaps(chain, max_pixels, visible), parts);
    }
    std::vector<float> pixels = std::move(visible.pixels);
    visible = joined(parts);
    visible.pixels = std::move(pixels);
}

}  // namespace exemplar
