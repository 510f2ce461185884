#include "host/lines/drawing.h"

#include <algorithm>
#include <array>

#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"

namespace exemplar {

namespace {

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

LineOptions options_of(LineType type, const DrawingStyle& style, const StrokeView& view) {
    LineOptions options;
    options.parallel_eye = view.camera.projection(3, 3) != 0;
    options.eye = options.parallel_eye ? view.camera.to_eye(Vec3::Zero()) : view.camera.position();
    options.feature_size = view.feature_size;
    options.thresholds = style.thresholds(type);
    options.front_facing_only = true;
    return options;
}

}  // namespace

std::span<const LineType> drawing_order() {
    return k_order;
}

Drawing draw_lines(const LineSurface& surface, std::span<const LineType> types, const DrawingStyle& style,
                   const StrokeView& view, const VisibilityOptions& visibility) {
    Drawing drawing;
    drawing.width = view.width;
    drawing.height = view.height;
    Stopwatch watch;
    const auto lap = [&](double& seconds) {
        seconds += watch.wall();
        watch = {};
    };
    const LineVisibility scene(surface);
    lap(drawing.seconds.visibility);
    for (const LineType type : k_order) {
        if (std::find(types.begin(), types.end(), type) == types.end()) continue;
        check_interrupt();
        const LineOptions options = options_of(type, style, view);
        const std::vector<LineSegment> segments = extract_lines(surface, type, options);
        lap(drawing.seconds.lines);
        const VisibleParts visible =
            scene.visible_parts(type, segments, view.camera, view.width, view.height, visibility);
        lap(drawing.seconds.visibility);
        const std::vector<Chain> chains = chain_segments(surface.faces, surface.neighbors, segments);
        drawing.layers.push_back({type, segments.size(),
                                  make_strokes(surface, type, segments, chains, &visible, view, options.thresholds,
                                               style.of(type).thickness)});
        lap(drawing.seconds.strokes);
    }
    return drawing;
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
    // The last run goes on in the first.
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
