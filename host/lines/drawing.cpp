#include "host/lines/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"

namespace exemplar {

namespace {

constexpr float k_short_gap = 3;  // pixels that lines across smooth surfaces may be hidden for without a break

constexpr std::array k_order = {LineType::suggestive_highlights,
                                LineType::principal_highlights,
                                LineType::valleys,
                                LineType::ridges,
                                LineType::apparent_ridges,
                                LineType::suggestive_contours,
                                LineType::creases,
                                LineType::boundaries,
                                LineType::contours};
static_assert(k_order.size() == k_line_types.size());

bool contains(std::span<const LineType> types, LineType type) {
    return std::find(types.begin(), types.end(), type) != types.end();
}

LineOptions options_of(LineType type, std::span<const LineType> types, const DrawingStyle& style,
                       const StrokeView& view) {
    LineOptions options;
    options.parallel_eye = view.camera.projection(3, 3) != 0;
    options.eye = options.parallel_eye ? view.camera.to_eye(Vec3::Zero()) : view.camera.position();
    options.feature_size = view.feature_size;
    options.thresholds = style.thresholds(type);
    options.front_facing_only = true;
    options.contours_at_boundaries = !contains(types, LineType::boundaries);
    options.no_creases_on_outline = contains(types, LineType::contours);
    return options;
}

/// Makes the layers of a drawing one after the other, and adds up the time of the steps.
class Drawer {
  public:
    Drawer(const LineSurface& surface, std::span<const LineType> types, const DrawingStyle& style,
           const StrokeView& view, const VisibilityOptions& visibility, Drawing& drawing)
        : surface_(surface),
          types_(types),
          style_(style),
          view_(view),
          options_(visibility),
          drawing_(drawing),
          visibility_(surface) {
        lap(drawing_.seconds.visibility);
    }

    void add(LineType type) {
        const LineOptions options = options_of(type, types_, style_, view_);
        const std::vector<LineSegment> segments = extract_lines(surface_, type, options);
        lap(drawing_.seconds.lines);
        VisibleParts visible =
            visibility_.visible_parts(type, segments, view_.camera, view_.width, view_.height, options_);
        lap(drawing_.seconds.visibility);
        const std::vector<Chain> chains =
            chain_segments(surface_.joined_faces(), surface_.neighbors, segments, type != LineType::contours);
        close_gaps(smooth_ones(type, chains, segments), k_short_gap, visible);
        DrawingLayer& layer = drawing_.layers.emplace_back();
        layer.type = type;
        layer.segments = segments.size();
        layer.strokes = make_strokes(surface_, type, segments, chains, &visible, view_, style_.thresholds(type),
                                     style_.of(type).thickness);
        lap(drawing_.seconds.strokes);
    }

  private:
    /// Returns the chains that do not run along edges, whose visibility is exact.
    static std::vector<Chain> smooth_ones(LineType type, const std::vector<Chain>& chains,
                                          const std::vector<LineSegment>& segments) {
        std::vector<Chain> result;
        std::ranges::copy_if(chains, std::back_inserter(result), [&](const Chain& chain) {
            return !runs_along_edge(type, segments[chain.links.front().segment]);
        });
        return result;
    }
    void lap(double& seconds) {
        seconds += watch_.wall();
        watch_ = {};
    }

    const LineSurface& surface_;
    std::span<const LineType> types_;
    const DrawingStyle& style_;
    const StrokeView& view_;
    const VisibilityOptions& options_;
    Drawing& drawing_;
    Stopwatch watch_;
    LineVisibility visibility_;
};

}  // namespace

std::span<const LineType> drawing_order() {
    return k_order;
}

Drawing draw_lines(const LineSurface& surface, std::span<const LineType> types, const DrawingStyle& style,
                   const StrokeView& view, const VisibilityOptions& visibility) {
    Drawing drawing;
    drawing.width = view.width;
    drawing.height = view.height;
    Drawer drawer(surface, types, style, view, visibility, drawing);
    for (const LineType type : k_order) {
        if (!contains(types, type)) continue;
        check_interrupt();
        drawer.add(type);
    }
    return drawing;
}

Drawing side_by_side(Drawing left, const Drawing& right) {
    const auto same_type = [](const DrawingLayer& a, const DrawingLayer& b) { return a.type == b.type; };
    if (left.height != right.height ||
        !std::equal(left.layers.begin(), left.layers.end(), right.layers.begin(), right.layers.end(), same_type))
        throw UsageError("drawings of different heights or types of lines cannot be put side by side; make them alike");
    const Vec2 offset(static_cast<float>(left.width), 0);
    for (std::size_t i = 0; i < left.layers.size(); ++i) {
        left.layers[i].segments += right.layers[i].segments;
        for (Stroke stroke : right.layers[i].strokes) {
            for (StrokePoint& point : stroke.points) point.position += offset;
            left.layers[i].strokes.push_back(std::move(stroke));
        }
    }
    left.width += right.width;
    left.seconds.lines += right.seconds.lines;
    left.seconds.visibility += right.seconds.visibility;
    left.seconds.strokes += right.seconds.strokes;
    return left;
}

namespace {

/// Returns the point at t on the way from a to b.
StrokePoint point_between(const StrokePoint& a, const StrokePoint& b, float t) {
    StrokePoint point = a;
    point.position += t * (b.position - a.position);
    const Vec2 normal = a.normal + t * (b.normal - a.normal);
    if (normal.squaredNorm() > 0) point.normal = normal.normalized();
    for (float StrokePoint::*const member :
         {&StrokePoint::depth, &StrokePoint::width, &StrokePoint::opacity, &StrokePoint::parameter})
        point.*member = std::lerp(a.*member, b.*member, t);
    return point;
}

/// Returns the part of the way from a to b within [0, most], as shares of the way; empty if the first is larger.
std::pair<float, float> part_within(const Vec2& a, const Vec2& b, const Vec2& most) {
    float from = 0, to = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const float way = b[axis] - a[axis];
        if (way == 0) {
            if (a[axis] < 0 || a[axis] > most[axis]) return {1, 0};
            continue;
        }
        const float at_zero = -a[axis] / way, at_most = (most[axis] - a[axis]) / way;
        from = std::max(from, std::min(at_zero, at_most));
        to = std::min(to, std::max(at_zero, at_most));
    }
    return {from, to};
}

/// Joins the last run of a closed stroke with the first, in which it continues; parameters keep increasing.
void join_last_with_first(std::vector<StrokeRun>& runs, float length) {
    std::vector<StrokePoint>& last = runs.back().points;
    for (std::size_t i = 1; i < runs.front().points.size(); ++i) {
        last.push_back(runs.front().points[i]);
        last.back().parameter += length;
    }
    runs.erase(runs.begin());
}

}  // namespace

std::vector<StrokeRun> within_picture(const StrokeRun& run, int width, int height) {
    const Vec2 most(static_cast<float>(width), static_cast<float>(height));
    std::vector<StrokeRun> parts;
    bool goes_on = false;  // whether the last part reaches the point that comes next
    for (std::size_t i = 0; i + 1 < run.points.size(); ++i) {
        const StrokePoint &a = run.points[i], &b = run.points[i + 1];
        const auto [from, to] = part_within(a.position, b.position, most);
        if (!(from < to)) {
            goes_on = false;
            continue;
        }
        if (!goes_on || from > 0) parts.push_back({{from > 0 ? point_between(a, b, from) : a}, false});
        parts.back().points.push_back(to < 1 ? point_between(a, b, to) : b);
        goes_on = to == 1;
    }
    if (!run.closed || parts.empty()) return parts;
    const bool starts = part_within(run.points[0].position, run.points[1].position, most).first == 0;
    if (parts.size() == 1 && parts.front().points.size() == run.points.size() && goes_on)
        parts.front().closed = true;
    else if (parts.size() > 1 && goes_on && starts)
        join_last_with_first(parts, run.points.back().parameter - run.points.front().parameter);
    return parts;
}

std::vector<StrokeRun> visible_runs(const Stroke& stroke) {
    const std::vector<StrokePoint>& points = stroke.points;
    std::vector<StrokeRun> runs;
    if (points.size() < 2) return runs;
    const std::size_t ways = points.size() - 1;
    for (std::size_t i = 0; i < ways; ++i) {
        if (!points[i].visible) continue;
        if (i == 0 || !points[i - 1].visible) runs.push_back({{points[i]}, false});
        runs.back().points.push_back(points[i + 1]);
    }
    if (!stroke.closed || runs.empty() || !points.front().visible || !points[ways - 1].visible) return runs;
    if (runs.size() == 1 && runs.front().points.size() == points.size()) {
        runs.front().closed = true;
        return runs;
    }
    join_last_with_first(runs, points.back().parameter);
    return runs;
}

float length_of(const StrokeRun& run) {
    return run.points.back().parameter - run.points.front().parameter;
}

}  // namespace exemplar
