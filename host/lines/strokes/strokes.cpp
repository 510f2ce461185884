#include "host/lines/strokes/strokes.h"

#include <fmt/format.h>

#include <limits>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {

namespace {

constexpr std::size_t k_chain_grain = 16;  // chains that one thread takes at a time
constexpr float k_taper_step = 0.2f;       // maximum distance of two points, in tapers
constexpr float k_max_pieces = 10000;      // maximum pieces of a link

void check_stroke_input(const LineSurface& surface, std::span<const LineSegment> segments,
                        std::span<const Chain> chains, const VisibleParts* visible) {
    const VertexCurvature& c = surface.curvature;
    if (!c.k1.empty())
        for (const std::size_t have : {c.k1.size(), c.k2.size(), c.e1.size(), c.e2.size()})
            if (have != surface.vertices.size())
                throw UsageError(fmt::format("{} curvatures for {} vertices: compute them for the same mesh", have,
                                             surface.vertices.size()));
    if (visible && visible->segment_count() != segments.size())
        throw UsageError(fmt::format("visible parts of {} segments for {}: compute them for the same lines",
                                     visible->segment_count(), segments.size()));
    for (std::size_t s = 0; s < segments.size(); ++s)
        if (segments[s].face >= surface.faces.size())
            throw UsageError(fmt::format("segment {} names face {}, but there are {}: extract the lines of this mesh",
                                         s, segments[s].face, surface.faces.size()));
    for (std::size_t i = 0; i < chains.size(); ++i)
        for (const ChainLink& link : chains[i].links)
            if (link.segment >= segments.size())
                throw UsageError(fmt::format("chain {} names segment {}, but there are {}: chain the same segments", i,
                                             link.segment, segments.size()));
}

void check_stroke_input(const StrokeView& view, const StrokeThickness& t) {
    if (view.width <= 0 || view.height <= 0 || !(view.unit_depth > 0))
        throw UsageError(fmt::format("a view of {} x {} pixels with a unit of depth of {}: give positive numbers",
                                     view.width, view.height, view.unit_depth));
    const bool right = t.width > 0 && t.epsilon > 0 && t.most > 0 && t.least >= 0 && t.least <= t.most && t.taper >= 0;
    if (!right || !std::isfinite(t.width + t.epsilon + t.most + t.taper))
        throw UsageError(fmt::format(
            "strokes of width {} in [{}, {}] with epsilon {} and taper {}: width, epsilon and the largest width must "
            "be positive, the least between zero and that, the taper not negative",
            t.width, t.least, t.most, t.epsilon, t.taper));
}

Vec2 across(const Vec2& tangent) {
    return Vec2(-tangent.y(), tangent.x()).normalized();
}

/// Smooths the points of a chain (see make_strokes) and sets their normals.
class ChainSmoother {
  public:
    ChainSmoother(const std::vector<StrokePoint>& points, bool closed, bool tapers)
        : points_(points), closed_(closed), tapers_(tapers) {}

    std::vector<StrokePoint> smoothed_points() const {
        std::vector<StrokePoint> result = points_;
        const auto last = static_cast<std::ptrdiff_t>(points_.size()) - 1;
        for (std::ptrdiff_t i = 0; i <= last; ++i) {
            const Side before = side(i, -1), after = side(i, 1);
            StrokePoint& point = result[static_cast<std::size_t>(i)];
            const Vec2 tangent = after.end - before.end;
            if (tangent.squaredNorm() > 0) point.normal = across(tangent);
            const float length = before.length + after.length;
            if (tapers_) point.width *= straightness(tangent.norm(), length);
            const bool stays = !closed_ && (i == 0 || i == last);
            if (!stays && length > 0) point.position = (before.sum + after.sum) / length;
        }
        return result;
    }

  private:
    /// The window on one side of a point: integral of the position over its length, length, and end.
    struct Side {
        Vec2 sum = Vec2::Zero();
        float length = 0;
        Vec2 end;
    };
    /// Returns the next point in a direction. Wraps around on closed chains, whose last point is the first; stays at
    /// the end of others.
    std::ptrdiff_t step(std::ptrdiff_t i, std::ptrdiff_t way) const {
        const auto last = static_cast<std::ptrdiff_t>(points_.size()) - 1;
        const std::ptrdiff_t next = i + way;
        if (next >= 0 && next <= last) return next;
        return closed_ ? (way > 0 ? way : last + way) : i;
    }
    const Vec2& at(std::ptrdiff_t i) const { return points_[static_cast<std::size_t>(i)].position; }
    Side side(std::ptrdiff_t i, std::ptrdiff_t way) const {
        float reach = 0;
        std::ptrdiff_t here = i;
        for (int k = 0; k < k_smoothing_window_reach; ++k) {
            const std::ptrdiff_t next = step(here, way);
            reach += (at(next) - at(here)).norm();
            here = next;
        }
        reach = std::clamp(reach, k_min_smoothing_window, k_max_smoothing_window);
        Side result;
        result.end = at(i);
        here = i;
        for (int k = 0; k < k_smoothing_window_points && result.length < reach; ++k) {
            const std::ptrdiff_t next = step(here, way);
            const Vec2 on = at(next) - at(here);
            const float length = on.norm(), part = std::min(length, reach - result.length);
            if (length > 0) {
                const Vec2 end = at(here) + part / length * on;
                result.sum += part * 0.5f * (at(here) + end);
                result.length += part;
                result.end = end;
            }
            here = next;
        }
        return result;
    }
    const std::vector<StrokePoint>& points_;
    bool closed_, tapers_;
};

/// Makes the stroke of one chain.
class StrokeMaker {
  public:
    StrokeMaker(const LineSurface& surface, LineType type, std::span<const LineSegment> segments,
                const VisibleParts* visible, const StrokeView& view, const LineThresholds& thresholds,
                const StrokeThickness& thickness)
        : surface_(surface),
          type_(type),
          segments_(segments),
          visible_(visible),
          view_(view),
          thresholds_(thresholds),
          thickness_(thickness),
          backward_(view.camera.view.block<1, 3>(2, 0).transpose()),
          parallel_(view.camera.projection(3, 3) != 0) {}

    Stroke stroke_of(const Chain& chain) const {
        std::vector<StrokePoint> own;
        for (const ChainLink& link : chain.links) own.push_back(point_of(link, 0));
        if (!chain.links.empty()) own.push_back(point_of(chain.links.back(), 1));
        replace_lost_positions(own);
        if (chain.closed) own.back().position = own.front().position;
        set_parameters(own);
        const bool along_edge = !chain.links.empty() && runs_along_edge(type_, segments_[chain.links.front().segment]);
        if (along_edge)
            set_normals(chain.closed, own);
        else
            own = ChainSmoother(own, chain.closed, thickness_.taper > 0).smoothed_points();
        Stroke stroke;
        stroke.closed = chain.closed;
        for (std::size_t i = 0; i < chain.links.size(); ++i)
            add_link(chain.links[i], own[i], own[i + 1], stroke.points);
        if (!own.empty()) stroke.points.push_back(own.back());
        finish_last_point(stroke);
        if (!along_edge && thickness_.taper > 0)
            taper(stroke, goes_on_along_edge(chain, 0), goes_on_along_edge(chain, 1));
        return stroke;
    }

  private:
    /// Returns the point at t along a link, without normal and parameter.
    StrokePoint point_of(const ChainLink& link, float t) const {
        const LineSegment& segment = segments_[link.segment];
        const float s = link.reversed ? 1 - t : t;
        const Face& face = surface_.faces[segment.face];
        Vec3 place = Vec3::Zero();
        float curvature = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const float weight = segment.ends[0][i] + s * (segment.ends[1][i] - segment.ends[0][i]);
            place += weight * surface_.vertices[face[i]];
            curvature += weight * radial_curvature(face[i]);
        }
        const Vec3 projected = view_.camera.project(place, view_.width, view_.height);
        const float depth = -backward_.dot(place) - view_.camera.view(2, 3);
        StrokePoint point;
        point.face = segment.face;
        point.position = projected.head<2>();
        point.depth = projected.z();
        point.width = stroke_width(thickness_, curvature * view_.feature_size,
                                   parallel_ ? 1 : std::max(depth / view_.unit_depth, 1e-6f));
        const float strength = segment.strength[0] + s * (segment.strength[1] - segment.strength[0]);
        point.opacity = line_opacity(type_, strength, thresholds_);
        return point;
    }
    float radial_curvature(std::uint32_t vertex) const {
        const VertexCurvature& c = surface_.curvature;
        if (c.k1.empty()) return 0;
        const Vec3 to_eye = view_.camera.to_eye(surface_.vertices[vertex]);
        const float u = c.e1[vertex].dot(to_eye), v = c.e2[vertex].dot(to_eye), squared_sine = u * u + v * v;
        if (!(squared_sine > 0)) return 0.5f * (c.k1[vertex] + c.k2[vertex]);
        return (c.k1[vertex] * u * u + c.k2[vertex] * v * v) / squared_sine;
    }
    /// Replaces positions of points in the plane of the eye, which have no projection. Such points are never
    /// visible, but must not spoil their neighbors.
    static void replace_lost_positions(std::vector<StrokePoint>& points) {
        for (std::size_t i = 0; i < points.size(); ++i)
            if (!points[i].position.allFinite()) points[i].position = i > 0 ? points[i - 1].position : Vec2::Zero();
    }
    static void set_parameters(std::vector<StrokePoint>& points) {
        for (std::size_t i = 1; i < points.size(); ++i)
            points[i].parameter = points[i - 1].parameter + (points[i].position - points[i - 1].position).norm();
    }
    static void set_normals(bool closed, std::vector<StrokePoint>& points) {
        const auto last = static_cast<std::ptrdiff_t>(points.size()) - 1;
        const auto at = [&](std::ptrdiff_t i) -> const Vec2& {
            return points[static_cast<std::size_t>(closed ? (i % last + last) % last
                                                          : std::clamp<std::ptrdiff_t>(i, 0, last))]
                .position;
        };
        // Returns the direction from a point to one some pixels on, so that steps of less do not turn normals.
        const auto direction = [&](std::ptrdiff_t i, std::ptrdiff_t way) {
            Vec2 on = Vec2::Zero();
            for (std::ptrdiff_t k = 1; k <= k_smoothing_window_points && !(on.norm() >= k_min_smoothing_window); ++k)
                on = at(i + k * way) - at(i);
            return Vec2(on.normalized());
        };
        for (std::ptrdiff_t i = 0; i <= last; ++i) {
            const Vec2 ahead = direction(i, 1), tangent = ahead - direction(i, -1);
            const bool turns_back = !(tangent.norm() > k_least_tangent);
            if (const Vec2 chosen = turns_back ? ahead : tangent; chosen.squaredNorm() > 0)
                points[static_cast<std::size_t>(i)].normal = across(chosen);
        }
    }
    /// Adds the first point of a link, those where visibility changes, and enough others for tapers.
    void add_link(const ChainLink& link, const StrokePoint& first, const StrokePoint& last,
                  std::vector<StrokePoint>& points) const {
        const std::size_t begin = points.size();
        points.push_back(first);
        if (visible_) add_changes(link, first, last, points);
        refine(link, first, last, begin, points);
    }
    void add_changes(const ChainLink& link, const StrokePoint& first, const StrokePoint& last,
                     std::vector<StrokePoint>& points) const {
        points.back().visible = false;
        const std::span<const VisiblePart> parts = visible_->of(link.segment);
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const VisiblePart& part = parts[link.reversed ? parts.size() - 1 - i : i];
            const float from = link.reversed ? 1 - part.to : part.from, to = link.reversed ? 1 - part.from : part.to;
            if (from > 0) points.push_back(between(link, first, last, from));
            points.back().visible = true;
            if (!(to < 1)) continue;
            points.push_back(between(link, first, last, to));
            points.back().visible = false;
        }
    }
    void refine(const ChainLink& link, const StrokePoint& first, const StrokePoint& last, std::size_t begin,
                std::vector<StrokePoint>& points) const {
        const float step = k_taper_step * thickness_.taper, length = last.parameter - first.parameter;
        const float wanted = std::ceil(std::min(length / step, k_max_pieces));
        if (!(step > 0 && wanted > 1)) return;
        std::vector<StrokePoint> added;
        std::size_t i = begin;
        for (float k = 1; k < wanted; ++k) {
            StrokePoint point = between(link, first, last, k / wanted);
            while (i < points.size() && points[i].parameter <= point.parameter) added.push_back(points[i++]);
            point.visible = added.back().visible;
            added.push_back(point);
        }
        added.insert(added.end(), points.begin() + static_cast<std::ptrdiff_t>(i), points.end());
        points.resize(begin);
        points.insert(points.end(), added.begin(), added.end());
    }
    StrokePoint between(const ChainLink& link, const StrokePoint& first, const StrokePoint& last, float t) const {
        StrokePoint point = point_of(link, t);
        point.position = first.position + t * (last.position - first.position);
        point.parameter = first.parameter + t * (last.parameter - first.parameter);
        const Vec2 normal = first.normal + t * (last.normal - first.normal);
        point.normal = normal.squaredNorm() > 0 ? Vec2(normal.normalized()) : first.normal;
        return point;
    }
    /// Sets the last point: in an open chain it is as visible as the last piece; in a closed one it equals the
    /// first.
    static void finish_last_point(Stroke& stroke) {
        if (stroke.points.empty()) return;
        StrokePoint& last = stroke.points.back();
        if (!stroke.closed) {
            last.visible = stroke.points.size() > 1 && stroke.points[stroke.points.size() - 2].visible;
            return;
        }
        const float parameter = last.parameter;
        last = stroke.points.front();
        last.parameter = parameter;
    }
    /// Returns whether a contour ends on an edge, along which another goes on. `end`: 0 for its first, 1 for its last.
    bool goes_on_along_edge(const Chain& chain, std::size_t end) const {
        if (type_ != LineType::contours || chain.closed || chain.links.empty() || surface_.neighbors.empty())
            return false;
        const ChainLink& link = end == 0 ? chain.links.front() : chain.links.back();
        const LineSegment& segment = segments_[link.segment];
        const SegmentEnd place = segment.places[link.reversed ? 1 - end : end];
        if (place >= k_at_corner) return false;
        const std::uint32_t across = surface_.neighbors[segment.face][place];
        return !has_neighbor(across) || (across & k_sharp_side) != 0;
    }
    /// `first_goes_on`, `last_goes_on`: whether the stroke keeps its width to that end.
    void taper(Stroke& stroke, bool first_goes_on, bool last_goes_on) const {
        constexpr float k_far = std::numeric_limits<float>::max();
        std::vector<StrokePoint>& points = stroke.points;
        if (points.size() < 2) return;
        const float length = points.back().parameter;
        // Distances to the nearest ends of visible runs behind and ahead; closed chains take two rounds.
        std::vector<float> distance(points.size(), k_far);
        float end = stroke.closed || first_goes_on ? -k_far : 0;
        const auto is_end = [&](std::size_t i) {
            return !points[i].visible || (i > 0 ? !points[i - 1].visible : stroke.closed && !before_first(points));
        };
        for (const float lap : {stroke.closed ? -length : 0.0f, 0.0f}) {
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (is_end(i)) end = points[i].parameter + lap;
                distance[i] = std::min(distance[i], points[i].parameter - end);
            }
            if (!stroke.closed) break;
        }
        end = stroke.closed || last_goes_on ? k_far : length;
        for (const float lap : {stroke.closed ? length : 0.0f, 0.0f}) {
            for (std::size_t i = points.size(); i-- > 0;) {
                if (is_end(i)) end = points[i].parameter + lap;
                distance[i] = std::min(distance[i], end - points[i].parameter);
            }
            if (!stroke.closed) break;
        }
        for (std::size_t i = 0; i < points.size(); ++i) points[i].width *= stroke_taper(distance[i], thickness_.taper);
    }
    static bool before_first(const std::vector<StrokePoint>& points) { return points[points.size() - 2].visible; }

    const LineSurface& surface_;
    LineType type_;
    std::span<const LineSegment> segments_;
    const VisibleParts* visible_;
    const StrokeView& view_;
    const LineThresholds& thresholds_;
    const StrokeThickness& thickness_;
    Vec3 backward_;
    bool parallel_;
};

}  // namespace

std::vector<Stroke> make_strokes(const LineSurface& surface, LineType type, std::span<const LineSegment> segments,
                                 std::span<const Chain> chains, const VisibleParts* visible, const StrokeView& view,
                                 const LineThresholds& thresholds, const StrokeThickness& thickness) {
    check_stroke_input(surface, segments, chains, visible);
    check_stroke_input(view, thickness);
    const StrokeMaker maker(surface, type, segments, visible, view, thresholds, thickness);
    std::vector<Stroke> strokes(chains.size());
    parallel_for(
        chains.size(), [&](std::size_t i) { strokes[i] = maker.stroke_of(chains[i]); }, k_chain_grain);
    return strokes;
}

}  // namespace exemplar
