#include "host/lines/drawing_svg.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/lines/strokes/stroke_raster.h"
#include "tests/lines/drawn_scene.h"

namespace exemplar {
namespace {

using namespace test_support;
namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// The paths of an SVG file: points, width of the stroke, and layer; read as strictly as they are written.
struct Path {
    std::string layer;
    std::vector<std::vector<Vec2>> lines;
    std::vector<bool> closed;
    float width = 0;
};

std::string attribute(const std::string& line, const std::string& name) {
    const std::size_t at = line.find(" " + name + "=\"");
    if (at == std::string::npos) return {};
    const std::size_t begin = at + name.size() + 3;
    return line.substr(begin, line.find('"', begin) - begin);
}

std::vector<Path> read_paths(const fs::path& file) {
    std::vector<Path> paths;
    std::string layer, text = read_file(file);
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        const std::string line = text.substr(at, end - at);
        at = end + 1;
        if (line.find("<g ") != std::string::npos) layer = attribute(line, "inkscape:label");
        if (line.find("<path ") == std::string::npos) continue;
        Path path;
        path.layer = layer;
        if (const std::string width = attribute(line, "stroke-width"); !width.empty()) path.width = std::stof(width);
        const std::string data = attribute(line, "d");
        for (const char* c = data.c_str(); *c != 0;) {
            if (*c == 'Z') {
                path.closed.back() = true;
                ++c;
                continue;
            }
            EXPECT_TRUE(*c == 'M' || *c == 'L') << data;
            if (*c == 'M') {
                path.lines.emplace_back();
                path.closed.push_back(false);
            }
            char* next = nullptr;
            const float x = std::strtof(c + 1, &next), y = std::strtof(next, &next);
            path.lines.back().emplace_back(x, y);
            c = next;
        }
        paths.push_back(path);
    }
    return paths;
}

fs::path svg_file(const char* name) {
    return fs::path(::testing::TempDir()) / name;
}

FloatImage white() {
    return FloatImage(k_size, k_size, 3, 1.0f);
}
/// Mean difference of two pictures, as a share of the mean darkness of the first.
double difference(const FloatImage& a, const FloatImage& b) {
    double different = 0, dark = 0;
    for (std::size_t i = 0; i < a.data.size(); ++i) {
        different += std::abs(double(a.data[i]) - double(b.data[i]));
        dark += 1 - double(a.data[i]);
    }
    return different / dark;
}

TEST(SvgDrawings, OfCenterLinesLookLikeTheStrokes) {
    const Scene scene(knobbly(4));
    const DrawingStyle style = load_style("ink");
    const std::array types = {LineType::contours, LineType::suggestive_contours, LineType::ridges};
    const Drawing drawing = draw(scene, style, types);
    const fs::path file = svg_file("lines.svg");
    SvgOptions options;
    options.fading = SvgFading::none;
    options.shortest = 0;
    const SvgSummary summary = write_drawing_svg(file, {&drawing, 1}, style, options);
    const std::vector<Path> paths = read_paths(file);
    EXPECT_EQ(paths.size(), summary.paths);
    FloatImage expected = white(), found = white();
    for (DrawingLayer layer : drawing.layers) {
        for (Stroke& stroke : layer.strokes)
            for (StrokePoint& point : stroke.points) point.opacity = 1;
        draw_strokes(layer.strokes, black(), {}, expected);
    }
    for (const Path& path : paths)
        for (std::size_t i = 0; i < path.lines.size(); ++i) {
            Stroke stroke;
            for (const Vec2& position : path.lines[i]) {
                stroke.points.emplace_back();
                stroke.points.back().position = position;
                stroke.points.back().width = path.width;
            }
            if (path.closed[i]) stroke.points.push_back(stroke.points.front());
            draw_strokes({&stroke, 1}, black(), {}, found);
        }
    EXPECT_LT(difference(expected, found), 0.12);  // widths are of steps of a fifth
    fs::remove(file);
}

TEST(SvgDrawings, OfCurvesStayBesideTheStraightLinesAndHaveNoKinks) {
    const Scene scene(knobbly(5));
    const DrawingStyle style = load_style("technical");
    const std::array types = {LineType::contours};
    const Drawing drawing = draw(scene, style, types);
    const fs::path file = svg_file("curves.svg");
    SvgOptions options{.fading = SvgFading::none};
    write_drawing_svg(file, {&drawing, 1}, style, options);
    const auto straight = read_paths(file);
    options.curves = true;
    write_drawing_svg(file, {&drawing, 1}, style, options);
    const std::string text = read_file(file);
    std::size_t path = 0, turns = 0, kinks = 0;
    for (std::size_t at = text.find(" d=\"M"); at != std::string::npos; at = text.find(" d=\"M", at + 1), ++path) {
        // M p then C a b p, again and again.
        std::vector<Vec2> points;
        for (const char* c = text.c_str() + at + 4; *c != '"' && *c != 'Z';) {
            char* next = nullptr;
            const float x = std::strtof(c + 1, &next), y = std::strtof(next, &next);
            points.emplace_back(x, y);
            c = next;
        }
        ASSERT_EQ(points.size() % 3, 1);
        const auto& line = straight.at(path).lines.at(0);
        const bool closed = straight[path].closed[0];
        ASSERT_EQ((points.size() - 1) / 3, line.size() - (closed ? 0 : 1));
        for (std::size_t i = 0; i + 1 < points.size(); i += 3) {
            EXPECT_EQ(points[i], line[i / 3]);
            const Vec2 way = (points[i + 3] - points[i]).normalized();
            for (std::size_t k : {1, 2}) {
                const Vec2 off = points[i + k] - points[i];
                EXPECT_LE(std::abs(way.x() * off.y() - way.y() * off.x()), 0.52f);
            }
            if (i == 0) continue;
            const Vec2 in = points[i] - points[i - 1], out = points[i + 1] - points[i];
            if (std::min(in.norm(), out.norm()) < 0.3f) continue;  // rounded to hundredths
            ++turns;
            kinks += in.normalized().dot(out.normalized()) < 0.99f ? 1u : 0u;
        }
    }
    EXPECT_EQ(path, straight.size());
    EXPECT_GT(turns, 100);
    EXPECT_LT(kinks, turns / 10);
    fs::remove(file);
}

/// What filled polygons cover, in 4 x 4 samples a pixel, by the nonzero rule.
void fill(const Path& path, FloatImage& image) {
    constexpr int k_samples = 4;
    Vec2 low(1e9f, 1e9f), high(-1e9f, -1e9f);
    for (const auto& line : path.lines)
        for (const Vec2& p : line) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    const auto winding = [&](double x, double y) {
        int turns = 0;
        for (const auto& line : path.lines)
            for (std::size_t i = 0; i < line.size(); ++i) {
                const Vec2 &a = line[i], &b = line[(i + 1) % line.size()];
                if ((double(a.y()) > y) == (double(b.y()) > y)) continue;
                const double cut = double(a.x()) + (y - double(a.y())) / (double(b.y()) - double(a.y())) *
                                                       (double(b.x()) - double(a.x()));
                if (cut > x) turns += a.y() > b.y() ? 1 : -1;
            }
        return turns;
    };
    for (int y = std::max(0, int(low.y())); y < std::min(k_size, int(high.y()) + 1); ++y)
        for (int x = std::max(0, int(low.x())); x < std::min(k_size, int(high.x()) + 1); ++x) {
            int inside = 0;
            for (int i = 0; i < k_samples; ++i)
                for (int j = 0; j < k_samples; ++j)
                    inside += winding(x + (i + 0.5) / k_samples, y + (j + 0.5) / k_samples) != 0;
            for (float& channel : image.pixel(x, y))
                channel *= 1 - static_cast<float>(inside) / (k_samples * k_samples);
        }
}

TEST(SvgDrawings, OfOutlinesLookLikeTheStrokes) {
    const Scene scene(knobbly(4));
    DrawingStyle style = load_style("ink");
    for (LineStyle& line : style.lines) {
        line.thickness.width *= 1.5f;
        line.thickness.most = 9;
    }
    const std::array types = {LineType::contours, LineType::suggestive_contours};
    const Drawing drawing = draw(scene, style, types);
    const fs::path file = svg_file("outlines.svg");
    SvgOptions options{.form = SvgForm::outlines, .fading = SvgFading::none, .shortest = 0};
    write_drawing_svg(file, {&drawing, 1}, style, options);
    FloatImage expected = white(), found = white();
    for (DrawingLayer layer : drawing.layers) {
        for (Stroke& stroke : layer.strokes)
            for (StrokePoint& point : stroke.points) point.opacity = 1;
        draw_strokes(layer.strokes, black(), {}, expected);
    }
    for (const Path& path : read_paths(file)) {
        for (const bool closed : path.closed) EXPECT_TRUE(closed);
        fill(path, found);
    }
    EXPECT_LT(difference(expected, found), 0.12);  // where strokes are thinner than a pixel, which covers half of two
    fs::remove(file);
}

TEST(SvgDrawings, HaveALayerPerTypeAndTheBackgroundInItsOwn) {
    const Scene scene(knobbly(3));
    const DrawingStyle style = load_style("blueprint");
    const Drawing drawing = draw(scene, style);
    const fs::path file = svg_file("layers.svg");
    write_drawing_svg(file, {&drawing, 1}, style, {});
    std::string text = read_file(file);
    for (const LineType type : k_line_types)
        EXPECT_THAT(text, HasSubstr("inkscape:label=\"" + std::string(name_of(type)) + "\""));
    EXPECT_THAT(text, HasSubstr("<rect width=\"400\" height=\"400\" fill=\"#16407c\"/>"));
    write_drawing_svg(file, {&drawing, 1}, style, {.background = false});
    EXPECT_THAT(read_file(file), Not(HasSubstr("<rect")));
    fs::remove(file);
}

TEST(SvgDrawings, DrawNothingTwiceAndTakeShortWays) {
    const Scene scene(knobbly(5));
    const DrawingStyle style = load_style("technical");
    const Drawing drawing = draw(scene, style);
    const fs::path file = svg_file("plot.svg");
    const SvgSummary summary = write_drawing_svg(file, {&drawing, 1}, style, {.fading = SvgFading::none});
    const auto paths = read_paths(file);
    double drawn = 0, between = 0;
    std::map<std::string, std::set<std::pair<float, float>>> starts;
    Vec2 pen = Vec2::Zero();
    for (const Path& path : paths)
        for (std::size_t i = 0; i < path.lines.size(); ++i) {
            const auto& line = path.lines[i];
            between += double((line.front() - pen).norm());
            for (std::size_t k = 0; k + 1 < line.size(); ++k) drawn += double((line[k + 1] - line[k]).norm());
            if (path.closed[i]) drawn += double((line.front() - line.back()).norm());
            pen = path.closed[i] ? line.front() : line.back();
        }
    EXPECT_NEAR(drawn, summary.length, 0.01 * summary.length);
    // An even line is one path: no more of them than there are visible runs.
    std::size_t runs = 0;
    for (const DrawingLayer& layer : drawing.layers)
        for (const Stroke& stroke : layer.strokes) runs += visible_runs(stroke).size();
    EXPECT_LE(paths.size(), runs);
    // In any order the way between two would be about half the picture's width.
    EXPECT_LT(between / static_cast<double>(paths.size()), 0.1 * k_size);
    fs::remove(file);
}

TEST(SvgDrawings, FadeTowardsTheBackground) {
    Drawing drawing;
    drawing.width = drawing.height = 10;
    drawing.layers.emplace_back();
    Stroke& stroke = drawing.layers[0].strokes.emplace_back();
    for (float x : {1.0f, 9.0f}) {
        stroke.points.emplace_back();
        stroke.points.back().position = {x, 5};
        stroke.points.back().parameter = x;
        stroke.points.back().width = 2;
        stroke.points.back().opacity = 0.5f;
    }
    DrawingStyle style;
    style.background = Color{255, 255, 255};
    const fs::path file = svg_file("fade.svg");
    const auto written = [&](const SvgOptions& options) {
        write_drawing_svg(file, {&drawing, 1}, style, options);
        return read_file(file);
    };
    EXPECT_THAT(written({}), HasSubstr("stroke-width=\"2\" stroke=\"#808080\""));
    EXPECT_THAT(written({.fading = SvgFading::width}), HasSubstr("stroke-width=\"1\"/>"));
    EXPECT_THAT(written({.fading = SvgFading::none}), HasSubstr("stroke-width=\"2\"/>"));
    EXPECT_THAT(written({.form = SvgForm::outlines}), HasSubstr("fill=\"#808080\""));
    style.background.reset();
    EXPECT_THAT(written({}), HasSubstr("opacity=\"0.5\""));
    fs::remove(file);
}

TEST(SvgDrawings, OfSeveralFramesPlay) {
    const Scene scene(knobbly(3));
    const DrawingStyle style = load_style("ink");
    const std::vector<Drawing> frames(3, draw(scene, style));
    const fs::path file = svg_file("frames.svg");
    write_drawing_svg(file, frames, style, {.frames_per_second = 10});
    const std::string text = read_file(file);
    EXPECT_THAT(text, HasSubstr("inkscape:label=\"frame 0\">"));
    EXPECT_THAT(text, HasSubstr("inkscape:label=\"frame 2\" display=\"none\">"));
    EXPECT_THAT(text, HasSubstr("values=\"inline;none\" keyTimes=\"0;0.333333\" dur=\"0.3s\""));
    EXPECT_THAT(text, HasSubstr("values=\"none;inline;none\" keyTimes=\"0;0.333333;0.666667\""));
    EXPECT_THAT(text, HasSubstr("values=\"none;inline\" keyTimes=\"0;0.666667\""));
    std::vector<Drawing> uneven = frames;
    uneven[1].width = 7;
    EXPECT_THROW(write_drawing_svg(file, uneven, style, {}), UsageError);
    EXPECT_THROW(write_drawing_svg(file, {}, style, {}), UsageError);
    EXPECT_THROW(write_drawing_svg(file, frames, style, {.frames_per_second = 0}), UsageError);
    EXPECT_THROW(write_drawing_svg("/proc/no/such.svg", frames, style, {}), DataError);
    fs::remove(file);
}

}  // namespace
}  // namespace exemplar
