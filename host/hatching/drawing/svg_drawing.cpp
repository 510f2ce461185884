#include "host/hatching/drawing/svg_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/hatching/fields/ink.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {
namespace {

constexpr double k_finer_page = 2;  ///< pixels of an aligned page per pixel of the view, as scans have them

constexpr double k_faintest_stroke = 0.004;  ///< darkness: a step of 8 bits

enum class StrokeRole { hatching, outline, other };

/// Returns what the innermost of a stroke's groups with a known name says that it is.
StrokeRole role_of(const SvgPicture& picture, const SvgStroke& stroke) {
    constexpr std::array<std::string_view, 4> k_outlines{"outline", "outlines", "contour", "contours"};
    for (int group = stroke.group; group >= 0; group = picture.groups[static_cast<std::size_t>(group)].outer) {
        const std::string name = lower_case(picture.groups[static_cast<std::size_t>(group)].name);
        if (std::ranges::find(k_outlines, name) != k_outlines.end()) return StrokeRole::outline;
        if (line_type_named(name)) return StrokeRole::other;
    }
    return StrokeRole::hatching;
}

double darkness_of(const SvgStroke& stroke) {
    const Color& c = stroke.color;
    return stroke.opacity * (1 - (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]) / 255);
}

bool is_colored(const SvgStroke& stroke) {
    constexpr int k_colored_line = 48;  // of 255, between the lightest and the darkest channel
    return std::ranges::max(stroke.color) - std::ranges::min(stroke.color) > k_colored_line;
}

double ink_of(const SvgStroke& stroke) {
    double length = 0;
    for (std::size_t i = 1; i < stroke.points.size(); ++i) length += (stroke.points[i] - stroke.points[i - 1]).norm();
    return length * stroke.width * darkness_of(stroke);
}

/// Whether most of the ink has a color.
bool is_drawn_in_color(const SvgPicture& picture) {
    double colored = 0, all = 0;
    for (const SvgStroke& stroke : picture.strokes) {
        const double ink = ink_of(stroke);
        all += ink;
        if (is_colored(stroke)) colored += ink;
    }
    return 2 * colored > all;
}

StrokePath path_of_stroke(const SvgStroke& stroke, bool outline) {
    StrokePath path{{}, {}, stroke.closed, static_cast<float>(darkness_of(stroke)), outline};
    path.widths.assign(stroke.points.size(), static_cast<float>(stroke.width));
    path.points.reserve(stroke.points.size());
    for (const Eigen::Vector2d& point : stroke.points) path.points.push_back(point.cast<float>());
    return path;
}

/// Whether a path goes on where the one before it in the file ended: a pen whose width changes is written as pieces of
/// one width each.
bool goes_on(const StrokePath& before, const StrokePath& path) {
    constexpr float k_max_gap = 0.05f, k_max_turn = 0.8f;  // widths; cosine
    if (before.closed || path.closed || before.darkness != path.darkness || before.outline != path.outline)
        return false;
    const float gap = (path.points.front() - before.points.back()).norm();
    if (gap > k_max_gap * std::min(before.widths.back(), path.widths.front())) return false;
    const Vec2 arrival = before.points.back() - before.points[before.points.size() - 2];
    const Vec2 departure = path.points[1] - path.points.front();
    return arrival.dot(departure) > k_max_turn * arrival.norm() * departure.norm();
}

void append(const StrokePath& path, StrokePath& before) {
    before.widths.back() = (before.widths.back() + path.widths.front()) / 2;
    before.points.insert(before.points.end(), path.points.begin() + 1, path.points.end());
    before.widths.insert(before.widths.end(), path.widths.begin() + 1, path.widths.end());
}

std::vector<StrokePath> moved_paths(std::span<const StrokePath> paths, const Similarity& to) {
    std::vector<StrokePath> out(paths.begin(), paths.end());
    for (StrokePath& path : out) {
        for (Vec2& point : path.points) point = to.apply(point);
        for (float& width : path.widths) width *= static_cast<float>(to.scale());
    }
    return out;
}

FloatImage rendered(std::span<const StrokePath> paths, int width, int height) {
    FloatImage darkness(width, height, 1);
    darkness.data = render_ink(drawn_strokes(paths), width, height);
    return darkness;
}

AlignedDrawing measured_page(const SvgDrawing& drawing, DrawingAlignment alignment, const PixelFeatures& pixels) {
    const HatchingView& view = pixels.view();
    const std::vector<StrokePath> paths = moved_paths(drawing.paths, alignment.to_view);
    FloatImage darkness = rendered(paths, view.width, view.height);
    const ViewOutlines outlines = view_outlines(pixels.gbuffer());
    StrokeMeasurements strokes = measure_paths(paths, darkness, object_mask(pixels), {}, &outlines);
    if (strokes.median_thickness <= 0)
        throw DataError("no stroke of the drawing lies on the object; draw over the template, in its size");
    return {alignment, std::move(darkness), std::move(strokes)};
}

void require_aspect(const SvgDrawing& drawing, double width, double height, const char* what) {
    const double scale = width / drawing.width;
    if (std::abs(drawing.height * scale - height) > std::max(1.0, 0.01 * height))
        throw DataError(fmt::format("a page of {:.6g} x {:.6g} is not of the {}, which has {} x {} pixels",
                                    drawing.width, drawing.height, what, width, height));
}

}  // namespace

SvgDrawing svg_drawing(const SvgPicture& picture) {
    SvgDrawing drawing{picture.width, picture.height, {}};
    const bool in_color = is_drawn_in_color(picture);
    drawing.paths.reserve(picture.strokes.size());
    for (const SvgStroke& stroke : picture.strokes) {
        const StrokeRole role = role_of(picture, stroke);
        if (role == StrokeRole::other || (!in_color && is_colored(stroke)) || darkness_of(stroke) < k_faintest_stroke)
            continue;
        StrokePath path = path_of_stroke(stroke, role == StrokeRole::outline);
        if (!drawing.paths.empty() && goes_on(drawing.paths.back(), path))
            append(path, drawing.paths.back());
        else
            drawing.paths.push_back(std::move(path));
    }
    if (drawing.paths.empty()) throw DataError("the drawing is blank: all of its strokes are white");
    return drawing;
}

FloatImage svg_darkness(const SvgDrawing& drawing, int width) {
    const double scale = width / drawing.width, height = std::round(drawing.height * scale);
    if (!(height * width < 0x1p28)) throw UsageError("the drawing has more than 2^28 pixels");
    return rendered(moved_paths(drawing.paths, Similarity(scale, 0)), width, std::max(1, static_cast<int>(height)));
}

AlignedDrawing align_and_measure(const SvgDrawing& drawing, const PixelFeatures& pixels) {
    const HatchingView& view = pixels.view();
    constexpr double k_same_size = 0.5;
    if (std::abs(drawing.width - view.width) < k_same_size && std::abs(drawing.height - view.height) < k_same_size)
        return measure_in_place(drawing, pixels);
    const double scale = k_finer_page * std::max(view.width, view.height) / std::max(drawing.width, drawing.height);
    const int width = std::max(1, static_cast<int>(std::lround(scale * drawing.width)));
    DrawingAlignment alignment = align_drawing(svg_darkness(drawing, width), object_mask(pixels));
    alignment.to_view = Similarity(width / drawing.width, 0).then(alignment.to_view);
    return measured_page(drawing, alignment, pixels);
}

AlignedDrawing measure_in_place(const SvgDrawing& drawing, const PixelFeatures& pixels) {
    const HatchingView& view = pixels.view();
    require_aspect(drawing, view.width, view.height, "view");
    DrawingAlignment alignment;
    alignment.to_view = Similarity(view.width / drawing.width, 0);
    alignment.same_frame = true;
    return measured_page(drawing, alignment, pixels);
}

AlignedDrawing measure_on_sheet(const SvgDrawing& drawing, const DrawingSheet& sheet, const PixelFeatures& pixels) {
    require_aspect(drawing, sheet.width, sheet.height, "sheet");
    DrawingAlignment alignment;
    alignment.to_view = Similarity(sheet.width / drawing.width, 0, -sheet.view_corner.x(), -sheet.view_corner.y())
                            .then(Similarity(1 / sheet.view_scale, 0));
    alignment.same_frame = true;
    return measured_page(drawing, alignment, pixels);
}

}  // namespace exemplar
