#include "host/hatching/registration/outline_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/hatching/registration/pose_fit.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/view_outlines.h"
#include "host/imaging/gbuffer.h"

namespace exemplar {
namespace {

constexpr int k_line_rounds = 24;
constexpr double k_first_reach = 0.04, k_match_reach = 0.02;  ///< of the size
constexpr double k_last_reach = 3;                            ///< pixels
constexpr std::size_t k_outline_points = 1500;

/// A point of the object's outline as a pose shows it.
struct SeenPoint {
    Vec3d point;
    Vec2 place;
    Vec2d normal;           ///< unit, to the farther side
    float orientation = 0;  ///< along the outline
    bool outer = false;     ///< whether the background is behind it
};

struct SeenOutline {
    std::vector<SeenPoint> points;
    LineMap outer;                         ///< to find the nearest of them
    std::vector<std::size_t> outer_index;  ///< per point of `outer`
};

/// Returns the side of an outline pixel on which the surface ends, as the sum of steps to farther neighbors.
Vec2d farther_side(const GBuffer& gbuffer, int x, int y, bool& outer) {
    const float depth = gbuffer.depth[gbuffer.index(x, y)];
    Vec2d side(0, 0);
    outer = false;
    for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx) {
            const int u = x + dx, v = y + dy;
            if (u < 0 || v < 0 || u >= gbuffer.width || v >= gbuffer.height) continue;
            const float other = gbuffer.depth[gbuffer.index(u, v)];
            if (std::abs(dx) + std::abs(dy) == 1 && !std::isfinite(other)) outer = true;
            if (other > depth) side += std::isfinite(other) ? 0.25 * Vec2d(dx, dy) : Vec2d(dx, dy);
        }
    return side;
}

SeenOutline seen_outline(const TriangleMesh& mesh, const ViewPose& pose, const PoseFrame& frame) {
    const GBuffer gbuffer = render_gbuffer(mesh, pose_camera(pose, frame), frame.width, frame.height);
    const ViewOutlines outlines = view_outlines(gbuffer);
    std::vector<SeenPoint> points;
    std::vector<LinePoint> outer;
    std::vector<std::size_t> outer_index;
    const std::size_t stride = std::max<std::size_t>(1, outlines.count / k_outline_points) | 1;
    std::size_t passed = 0;
    for (int y = 1; y + 1 < frame.height; ++y)
        for (int x = 1; x + 1 < frame.width; ++x) {
            const std::size_t i = gbuffer.index(x, y);
            if (outlines.nearest[i] != static_cast<std::int32_t>(i) || passed++ % stride) continue;
            SeenPoint point;
            point.orientation = outlines.direction[i];
            const double along = static_cast<double>(point.orientation);
            point.normal = {-std::sin(along), std::cos(along)};
            if (point.normal.dot(farther_side(gbuffer, x, y, point.outer)) < 0) point.normal *= -1;
            // The outline runs between the last pixel that shows the nearer surface and the next one.
            const Vec2d place = Vec2d(x + 0.5, y + 0.5) + 0.5 * point.normal;
            point.place = place.cast<float>();
            point.point = unprojected(pose, frame, place, static_cast<double>(gbuffer.depth[i]));
            if (point.outer) {
                outer.push_back({point.place, point.orientation});
                outer_index.push_back(points.size());
            }
            points.push_back(point);
        }
    return {std::move(points), LineMap(frame.width, frame.height, std::move(outer)), std::move(outer_index)};
}

/// The matches of a round, and sums over all points, matched or not.
struct OutlineMatches {
    std::vector<LineMatch> matches;
    double cost = 0, squares = 0;
    std::size_t count = 0, outer = 0, explained = 0, close = 0;
};

void match_outline(const SeenOutline& seen, const DrawnLines& lines, double reach, double near, OutlineMatches& out) {
    for (const SeenPoint& point : seen.points) {
        const LinePoint* line = (point.outer ? lines.outer : lines.all).nearest(point.place, point.orientation);
        const Vec2d way = line ? (line->place - point.place).cast<double>() : Vec2d(1e9, 0);
        const double distance = way.norm(), gap = way.dot(point.normal);
        ++out.count;
        out.outer += point.outer;
        out.cost += std::min(1.0, distance * distance / (near * near));
        out.explained += point.outer && distance < near;
        if (point.outer && distance < k_last_reach) {
            ++out.close;
            out.squares += gap * gap;
        }
        if (distance < reach) out.matches.push_back({point.point, point.normal, gap});
    }
}

/// The drawn outline has to be the object's, too.
void match_drawing(const SeenOutline& seen, const DrawnLines& lines, double reach, double near, OutlineMatches& out) {
    const std::vector<LinePoint>& drawn = lines.outer.points();
    const std::size_t stride = std::max<std::size_t>(1, drawn.size() / k_outline_points);
    for (std::size_t i = 0; i < drawn.size(); i += stride) {
        const LinePoint* nearest = seen.outer.nearest(drawn[i].place, drawn[i].orientation);
        const Vec2d way = nearest ? (drawn[i].place - nearest->place).cast<double>() : Vec2d(1e9, 0);
        const double distance = way.norm();
        ++out.count;
        out.cost += std::min(1.0, distance * distance / (near * near));
        if (distance >= reach) continue;
        const SeenPoint& point =
            seen.points[seen.outer_index[static_cast<std::size_t>(nearest - seen.outer.points().data())]];
        out.matches.push_back({point.point, point.normal, way.dot(point.normal)});
    }
}

}  // namespace

OutlineFit fit_to_lines(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& start,
                        const DrawnLines& lines, float size) {
    const double near = std::max(k_last_reach, k_match_reach * static_cast<double>(size));
    const double first = std::max(near, k_first_reach * static_cast<double>(size));
    OutlineFit best{start};
    best.outlined = lines.outlined;
    ViewPose pose = start;
    for (int round = 0; round <= k_line_rounds; ++round) {
        const double done = static_cast<double>(round) / k_line_rounds;
        const double reach = first * std::pow(k_last_reach / first, done);
        const SeenOutline seen = seen_outline(mesh, pose, frame);
        OutlineMatches found;
        match_outline(seen, lines, reach, near, found);
        match_drawing(seen, lines, reach, near, found);
        if (found.matches.empty()) break;
        const double cost = found.cost / static_cast<double>(found.count);
        if (cost < best.cost) {
            best.pose = pose;
            best.cost = cost;
            best.residual = found.close ? std::sqrt(found.squares / static_cast<double>(found.close)) : k_last_reach;
            best.explained =
                static_cast<double>(found.explained) / static_cast<double>(std::max<std::size_t>(found.outer, 1));
        }
        pose = changed(pose, frame, fitting_change(pose, frame, found.matches, std::max(1.0, reach / 3)));
    }
    return best;
}

}  // namespace exemplar
