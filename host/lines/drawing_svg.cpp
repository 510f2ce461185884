#include "host/lines/drawing_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/imaging/svg.h"
#include "host/mesh/color_text.h"

namespace exemplar {

namespace {

constexpr float k_width_step = 0.2f;    // maximum change of width within a center line, per width of its run
constexpr float k_opacity_step = 0.2f;  // maximum change of opacity within a path
constexpr float k_max_bulge = 0.5f;     // maximum distance of control points from the chord, in pixels
constexpr float k_min_cosine = 0.7f;    // between a chord and the tangent; below it the point is a corner
constexpr float k_min_width = 0.05f;    // pixels; thinner paths are left out
constexpr float k_min_opacity = 0.02f;  // paler ones, too

struct SvgSize {
    int width = 0, height = 0;  ///< pixels
};

/// A part of a run that becomes one path.
struct SvgPiece {
    std::vector<StrokePoint> points;
    bool closed = false;
    bool begins = true, ends = true;  ///< whether its run begins or ends there
    float width = 0, opacity = 1;     ///< means along it

    const Vec2& begin() const { return points.front().position; }
    const Vec2& end() const { return points.back().position; }
};

/// Returns what simplification compares: position and, for outlines, half width.
Vec3 sides_of(const StrokePoint& point, bool outline) {
    return {point.position.x(), point.position.y(), outline ? 0.5f * point.width : 0};
}

float distance_to(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 way = b - a;
    const float squared = way.squaredNorm();
    const float t = squared > 0 ? std::clamp((p - a).dot(way) / squared, 0.0f, 1.0f) : 0;
    return (a + t * way - p).norm();
}

/// Leaves out points within the tolerance of the line between those that stay (Douglas and Peucker 1973).
std::vector<StrokePoint> simplified(const std::vector<StrokePoint>& points, float tolerance, bool outline) {
    std::vector<std::uint8_t> stays(points.size(), 0);
    stays.front() = stays.back() = 1;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        const Vec3 a = sides_of(points[first], outline), b = sides_of(points[last], outline);
        float farthest = tolerance;
        std::size_t split = 0;
        for (std::size_t i = first + 1; i < last; ++i) {
            const float distance = distance_to(sides_of(points[i], outline), a, b);
            if (!(distance > farthest)) continue;
            farthest = distance;
            split = i;
        }
        if (split == 0) continue;
        stays[split] = 1;
        open.emplace_back(first, split);
        open.emplace_back(split, last);
    }
    std::vector<StrokePoint> result;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (stays[i]) result.push_back(points[i]);
    return result;
}

/// Sets the mean width and opacity along a piece.
void set_means(SvgPiece& piece) {
    float length = 0, width = 0, opacity = 0;
    for (std::size_t i = 0; i + 1 < piece.points.size(); ++i) {
        const StrokePoint &a = piece.points[i], &b = piece.points[i + 1];
        const float way = std::max(b.parameter - a.parameter, 1e-6f);
        length += way;
        width += way * 0.5f * (a.width + b.width);
        opacity += way * 0.5f * (a.opacity + b.opacity);
    }
    piece.width = width / length;
    piece.opacity = opacity / length;
}

/// Cuts a run where its opacity or, for center lines, its width has changed too much.
std::vector<SvgPiece> pieces_of(const StrokeRun& run, const SvgOptions& options) {
    float widest = 0;
    for (const StrokePoint& point : run.points) widest = std::max(widest, point.width);
    const float width_step = options.form == SvgForm::lines ? k_width_step * widest : std::numeric_limits<float>::max();
    std::vector<SvgPiece> pieces;
    for (std::size_t first = 0; first + 1 < run.points.size();) {
        float low = run.points[first].width, high = low;
        float palest = run.points[first].opacity, darkest = palest;
        std::size_t last = first;
        while (last + 1 < run.points.size()) {
            const StrokePoint& next = run.points[last + 1];
            low = std::min(low, next.width);
            high = std::max(high, next.width);
            palest = std::min(palest, next.opacity);
            darkest = std::max(darkest, next.opacity);
            if (last > first && (high - low > width_step || darkest - palest > k_opacity_step)) break;
            ++last;
        }
        SvgPiece& piece = pieces.emplace_back();
        piece.points.assign(run.points.begin() + static_cast<std::ptrdiff_t>(first),
                            run.points.begin() + static_cast<std::ptrdiff_t>(last) + 1);
        set_means(piece);
        piece.begins = first == 0;
        piece.ends = last + 1 == run.points.size();
        first = last;
    }
    if (pieces.size() == 1) pieces.front().closed = run.closed;
    return pieces;
}

void apply_fading(SvgFading fading, StrokeRun& run) {
    if (fading == SvgFading::opacity) return;
    for (StrokePoint& point : run.points) {
        if (fading == SvgFading::width) point.width *= point.opacity;
        point.opacity = 1;
    }
}

/// Returns the parts of a stroke that are drawn, fading as wanted.
std::vector<StrokeRun> drawn_runs(const Stroke& stroke, const SvgSize& size, const SvgOptions& options) {
    std::vector<StrokeRun> drawn;
    for (const StrokeRun& visible : visible_runs(stroke))
        for (StrokeRun& run : within_picture(visible, size.width, size.height)) {
            if (length_of(run) < options.shortest) continue;
            apply_fading(options.fading, run);
            drawn.push_back(std::move(run));
        }
    return drawn;
}

/// Returns the pieces of a layer, stroke by stroke.
std::vector<SvgPiece> pieces_of(std::span<const Stroke> strokes, const SvgSize& size, const SvgOptions& options,
                                SvgSummary& summary) {
    std::vector<SvgPiece> pieces;
    for (const Stroke& stroke : strokes)
        for (const StrokeRun& run : drawn_runs(stroke, size, options)) {
            summary.length += static_cast<double>(length_of(run));
            for (SvgPiece& piece : pieces_of(run, options)) {
                if (piece.width < k_min_width || piece.opacity < k_min_opacity) continue;
                if (options.tolerance > 0)
                    piece.points = simplified(piece.points, options.tolerance, options.form == SvgForm::outlines);
                pieces.push_back(std::move(piece));
            }
        }
    return pieces;
}

/// Orders pieces for a pen, greedily: next is the piece with the end nearest to the pen. Center lines may be
/// reversed; outlines always start at their beginning.
std::vector<SvgPiece> ordered(std::vector<SvgPiece> pieces, SvgForm form) {
    std::vector<SvgPiece> result;
    result.reserve(pieces.size());
    std::vector<std::size_t> left(pieces.size());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] = i;
    Vec2 pen = Vec2::Zero();
    while (!left.empty()) {
        float nearest = std::numeric_limits<float>::max();
        std::size_t chosen = 0;
        bool turned = false;
        for (std::size_t i = 0; i < left.size() && nearest > 0; ++i) {
            const SvgPiece& piece = pieces[left[i]];
            const float to_begin = (piece.begin() - pen).squaredNorm();
            const float to_end = form == SvgForm::lines ? (piece.end() - pen).squaredNorm() : to_begin;
            if (std::min(to_begin, to_end) >= nearest) continue;
            nearest = std::min(to_begin, to_end);
            chosen = i;
            turned = to_end < to_begin;
        }
        SvgPiece& piece = pieces[left[chosen]];
        if (turned) std::reverse(piece.points.begin(), piece.points.end());
        pen = piece.end();
        result.push_back(std::move(piece));
        left[chosen] = left.back();
        left.pop_back();
    }
    return result;
}

/// Returns the control point of `at` towards another point: along the tangent, which is perpendicular to the normal.
/// A curve deviates from the chord by up to three quarters of the distance of its control points.
Vec2 control_point(const StrokePoint& at, const Vec2& other) {
    const Vec2 way = other - at.position;
    const float length = way.norm();
    if (!(length > 0)) return at.position;
    Vec2 tangent(at.normal.y(), -at.normal.x());
    if (tangent.dot(way) < 0) tangent = -tangent;
    const float cosine = tangent.dot(way) / length;
    if (cosine < k_min_cosine) return at.position + way / 3;  // a corner
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    return at.position + std::min(length / 3, k_max_bulge / std::max(sine, 1e-6f)) * tangent;
}

std::string center_line(const SvgPiece& piece, bool curves, const Vec2& most) {
    SvgPath path(most);
    path.move_to(piece.begin());
    const std::size_t count = piece.points.size() - (piece.closed && !curves ? 1 : 0);
    for (std::size_t i = 1; i < count; ++i) {
        const StrokePoint &from = piece.points[i - 1], &to = piece.points[i];
        if (curves)
            path.curve_to(control_point(from, to.position), control_point(to, from.position), to.position);
        else
            path.line_to(to.position);
    }
    if (piece.closed) path.close();
    return path.data();
}

Vec2 side(const StrokePoint& point, float sign) {
    return point.position + sign * 0.5f * point.width * point.normal;
}

/// Returns the outline of a piece: along its right side, around its end, back along its left side and around its
/// beginning. The outline of a closed piece is a ring.
std::string outline(const SvgPiece& piece, const Vec2& most) {
    constexpr float k_round = 0.3f;  // ends wider than this, in pixels, are half circles
    const std::vector<StrokePoint>& points = piece.points;
    SvgPath path(most);
    path.move_to(side(points.front(), 1));
    for (std::size_t i = 1; i < points.size(); ++i) path.line_to(side(points[i], 1));
    const auto turn = [&](const StrokePoint& end, bool round, const Vec2& to, float forward) {
        const Vec2 tangent(end.normal.y(), -end.normal.x());
        if (round && end.width > k_round)
            for (const float angle : {0.25f, 0.5f, 0.75f}) {
                const float a = angle * 3.14159265f;
                path.line_to(end.position +
                             0.5f * end.width * forward * (std::cos(a) * end.normal + std::sin(a) * tangent));
            }
        path.line_to(to);
    };
    if (piece.closed) {
        path.close();
        path.move_to(side(points.back(), -1));
    } else {
        turn(points.back(), piece.ends, side(points.back(), -1), 1);
    }
    for (std::size_t i = points.size() - 1; i-- > 0;) path.line_to(side(points[i], -1));
    if (!piece.closed) turn(points.front(), piece.begins, side(points.front(), 1), -1);
    path.close();
    return path.data();
}

/// Writes the layers of drawings into a document.
class SvgWriter {
  public:
    /// Without a background, pale strokes are transparent.
    SvgWriter(SvgDocument& document, const SvgSize& size, const std::optional<Color>& background,
              const SvgOptions& options)
        : document_(document),
          size_(size),
          most_(static_cast<float>(size.width), static_cast<float>(size.height)),
          background_(background),
          options_(options) {}

    void add_background() {
        if (!options_.background || !background_) return;
        document_.open_layer("background");
        document_.add("rect", std::vector<SvgAttribute>{{"width", svg_number(size_.width)},
                                                        {"height", svg_number(size_.height)},
                                                        {"fill", hex_of_color(*background_)}});
        document_.close();
    }
    /// Adds the strokes of a type of lines, a layer for each ink.
    void add_inked_layers(const DrawingLayer& layer, const LineStyle& line, const PartInks& inks) {
        const std::string name(name_of(layer.type));
        if (inks.empty()) return add_layer({name, line.color, line.opacity, layer.strokes});
        for (const auto& [ink, strokes] : strokes_by_ink(layer.strokes, inks))
            add_layer(
                {name_of_layer(name, inks, ink), inks.inks[ink].color.value_or(line.color), line.opacity, strokes});
    }
    void add_layer(const SvgLayer& layer) {
        const std::string color = hex_of_color(layer.color);
        std::vector<SvgAttribute> attributes = {{"fill", color}, {"stroke", "none"}};
        if (options_.form == SvgForm::lines)
            attributes = {
                {"fill", "none"}, {"stroke", color}, {"stroke-linecap", "round"}, {"stroke-linejoin", "round"}};
        document_.open_layer(layer.name, attributes);
        for (const SvgPiece& piece : ordered(pieces_of(layer.strokes, size_, options_, summary_), options_.form))
            add_piece(piece, layer);
        document_.close();
    }
    const SvgSummary& summary() const { return summary_; }

  private:
    void add_piece(const SvgPiece& piece, const SvgLayer& layer) {
        const bool lines = options_.form == SvgForm::lines;
        std::vector<SvgAttribute> attributes = {
            {"d", lines ? center_line(piece, options_.curves, most_) : outline(piece, most_)}};
        if (lines) attributes.emplace_back("stroke-width", svg_number(static_cast<double>(piece.width)));
        const float opacity = piece.opacity * layer.opacity;
        if (opacity < 0.995f && background_)
            attributes.emplace_back(lines ? "stroke" : "fill", hex_of_color(mixed(layer.color, opacity)));
        else if (opacity < 0.995f)
            attributes.emplace_back("opacity", svg_number(static_cast<double>(opacity)));
        document_.add("path", attributes);
        ++summary_.paths;
        summary_.points += piece.points.size();
    }
    /// Mixes a color with the background. Overlaps of paths where they meet would show if they were transparent.
    Color mixed(const Color& color, float opacity) const {
        Color result{};
        for (std::size_t c = 0; c < 3; ++c)
            result[c] = static_cast<std::uint8_t>(
                std::lround(std::lerp(static_cast<float>((*background_)[c]), static_cast<float>(color[c]), opacity)));
        return result;
    }

    SvgDocument& document_;
    SvgSize size_;
    Vec2 most_;  // coordinates
    const std::optional<Color>& background_;
    const SvgOptions& options_;
    SvgSummary summary_;
};

/// Shows a group only during its frame.
void add_animation(SvgDocument& document, std::size_t frame, std::size_t count, double frames_per_second) {
    const auto time = [&](std::size_t f) { return svg_number(static_cast<double>(f) / static_cast<double>(count), 6); };
    std::string values = frame > 0 ? "none;inline" : "inline",
                times = frame > 0 ? fmt::format("0;{}", time(frame)) : "0";
    if (frame + 1 < count) {
        values += ";none";
        times += fmt::format(";{}", time(frame + 1));
    }
    document.add("animate",
                 std::vector<SvgAttribute>{{"attributeName", "display"},
                                           {"calcMode", "discrete"},
                                           {"values", values},
                                           {"keyTimes", times},
                                           {"dur", svg_number(static_cast<double>(count) / frames_per_second, 4) + "s"},
                                           {"repeatCount", "indefinite"}});
}

void check_frames(std::span<const Drawing> frames, const SvgOptions& options) {
    if (frames.empty()) throw UsageError("no drawing to write as SVG; give at least one frame");
    for (const Drawing& frame : frames)
        if (frame.width != frames[0].width || frame.height != frames[0].height)
            throw UsageError(fmt::format("frames of {} x {} and {} x {} pixels in one SVG file; draw all in one size",
                                         frames[0].width, frames[0].height, frame.width, frame.height));
    if (!(options.frames_per_second > 0 && std::isfinite(options.frames_per_second) && options.tolerance >= 0))
        throw UsageError(fmt::format("{} frames a second, simplified to {} pixels: give positive numbers",
                                     options.frames_per_second, options.tolerance));
}

}  // namespace

SvgSummary write_layers_svg(const std::filesystem::path& path, int width, int height,
                            const std::optional<Color>& background, std::span<const SvgLayer> layers,
                            const SvgOptions& options) {
    SvgDocument document(width, height, options.title);
    SvgWriter writer(document, {width, height}, background, options);
    writer.add_background();
    for (const SvgLayer& layer : layers) {
        check_interrupt();
        writer.add_layer(layer);
    }
    write_svg(path, document);
    return writer.summary();
}

SvgSummary write_drawing_svg(const std::filesystem::path& path, std::span<const Drawing> frames,
                             const DrawingStyle& style, const SvgOptions& options, const PartInks& inks) {
    check_frames(frames, options);
    SvgDocument document(frames[0].width, frames[0].height, options.title);
    SvgWriter writer(document, {frames[0].width, frames[0].height}, style.background, options);
    writer.add_background();
    for (std::size_t f = 0; f < frames.size(); ++f) {
        check_interrupt();
        if (frames.size() > 1) {
            std::vector<SvgAttribute> attributes;
            if (f > 0) attributes.emplace_back("display", "none");
            document.open_layer(fmt::format("frame {}", f), attributes);
            add_animation(document, f, frames.size(), options.frames_per_second);
        }
        for (const DrawingLayer& layer : frames[f].layers) writer.add_inked_layers(layer, style.of(layer.type), inks);
        if (frames.size() > 1) document.close();
    }
    write_svg(path, document);
    return writer.summary();
}

}  // namespace exemplar
