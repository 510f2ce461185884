#include "host/lines/drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

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

bool is_edge(LineType type) {
    return type == LineType::creases || type == LineType::boundaries;
}

LineOptions options_of(LineType type, const DrawingStyle& style, const StrokeView& view) {
    LineOptions options;
    options.parallel_eye = view.camera.projection(3, 3) != 0;
    options.eye = options.parallel_eye ? view.camera.to_eye(Vec3::Zero()) : view.camera.position();
    options.feature_size = view.feature_size;
    options.thresholds = style.thresholds(type);
    options.front_facing_only = true;
    return options;
}

/// A surface with its index for visibility, which is built once.
struct Drawn {
    explicit Drawn(const LineSurface& of) : surface(of), visibility(of) {}
    LineSurface surface;
    LineVisibility visibility;
};

/// Makes the layers of a drawing one after the other, and adds up the time of the steps.
class Drawer {
  public:
    Drawer(const DrawingStyle& style, const StrokeView& view, const VisibilityOptions& visibility, Drawing& drawing)
        : style_(style), view_(view), visibility_(visibility), drawing_(drawing) {}

    Drawn prepare(const LineSurface& surface) {
        Drawn drawn(surface);
        lap(drawing_.seconds.visibility);
        return drawn;
    }
    std::vector<LineSegment> find(const Drawn& drawn, LineType type) {
        std::vector<LineSegment> segments = extract_lines(drawn.surface, type, options_of(type, style_, view_));
        lap(drawing_.seconds.lines);
        return segments;
    }
    /// Adds the strokes of segments of the type `found` to a layer, whose type may be another.
    void add(const Drawn& drawn, LineType found, const std::vector<LineSegment>& segments, DrawingLayer& layer) {
        VisibleParts visible =
            drawn.visibility.visible_parts(found, segments, view_.camera, view_.width, view_.height, visibility_);
        lap(drawing_.seconds.visibility);
        const LineSurface& surface = drawn.surface;
        const std::vector<Chain> chains = chain_segments(surface.faces, surface.neighbors, segments);
        if (!is_edge(found)) close_gaps(chains, k_short_gap, visible);
        const LineStyle& line = style_.of(layer.type);
        std::vector<Stroke> strokes = make_strokes(surface, layer.type, segments, chains, &visible, view_,
                                                   style_.thresholds(layer.type), line.thickness);
        layer.segments += segments.size();
        std::move(strokes.begin(), strokes.end(), std::back_inserter(layer.strokes));
        lap(drawing_.seconds.strokes);
    }

  private:
    void lap(double& seconds) {
        seconds += watch_.wall();
        watch_ = {};
    }
    const DrawingStyle& style_;
    const StrokeView& view_;
    const VisibilityOptions& visibility_;
    Drawing& drawing_;
    Stopwatch watch_;
};

/// Moves the creases on the outline, with one face turned to the eye and the other away, to the end. Returns where
/// they begin.
std::vector<LineSegment>::iterator outlines_of(const LineSurface& surface, const Camera& camera,
                                               std::vector<LineSegment>& creases) {
    const auto faces_eye = [&](std::uint32_t f) {
        const auto& [a, b, c] = surface.faces[f];
        const Vec3 &p = surface.vertices[a], &q = surface.vertices[b], &r = surface.vertices[c];
        return (q - p).cross(r - p).dot(camera.to_eye(p)) > 0;
    };
    return std::stable_partition(creases.begin(), creases.end(), [&](const LineSegment& segment) {
        const std::uint32_t across = surface.neighbors[segment.face][segment.places[0] - k_at_corner];
        return across > k_max_neighbor_code || faces_eye(segment.face) == faces_eye(across / 4);
    });
}

}  // namespace

std::span<const LineType> drawing_order() {
    return k_order;
}

Drawing draw_lines(const LineSurface& surface, std::span<const LineType> types, const DrawingStyle& style,
                   const StrokeView& view, const LineSurface* edges, const VisibilityOptions& visibility) {
    Drawing drawing;
    drawing.width = view.width;
    drawing.height = view.height;
    const auto wanted = [&](LineType type) { return std::find(types.begin(), types.end(), type) != types.end(); };
    Drawer drawer(style, view, visibility, drawing);
    const Drawn smooth = drawer.prepare(surface);
    std::optional<Drawn> own_edges;
    if (edges && (wanted(LineType::creases) || wanted(LineType::boundaries))) own_edges.emplace(drawer.prepare(*edges));
    const Drawn& sharp = own_edges ? *own_edges : smooth;
    std::vector<LineSegment> outlines;
    for (const LineType type : k_order) {
        if (!wanted(type)) continue;
        check_interrupt();
        DrawingLayer& layer = drawing.layers.emplace_back();
        layer.type = type;
        const Drawn& drawn = is_edge(type) ? sharp : smooth;
        std::vector<LineSegment> segments = drawer.find(drawn, type);
        if (type == LineType::creases && wanted(LineType::contours)) {
            const auto begin = outlines_of(drawn.surface, view.camera, segments);
            outlines.assign(begin, segments.end());
            segments.erase(begin, segments.end());
        }
        drawer.add(drawn, type, segments, layer);
        if (type == LineType::contours && !outlines.empty()) drawer.add(sharp, LineType::creases, outlines, layer);
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
    // The last run continues in the first.
    const float length = points.back().parameter;
    std::vector<StrokePoint>& last = runs.back().points;
    for (std::size_t i = 1; i < runs.front().points.size(); ++i) {
        last.push_back(runs.front().points[i]);
        last.back().parameter += length;
    }
    runs.erase(runs.begin());
    return runs;
}

float length_of(const StrokeRun& run) {
    return run.points.back().parameter - run.points.front().parameter;
}

}  // namespace exemplar
