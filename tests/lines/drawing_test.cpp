#include "host/lines/drawing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/split_surface.h"
#include "host/lines/stroke_raster.h"
#include "host/mesh/curvature_estimator.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr int k_size = 400;

struct Scene {
    TriangleMesh mesh;
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    std::vector<FaceNeighbors> neighbors;
    StrokeView view;

    explicit Scene(TriangleMesh shape, const Vec3& direction = {3, 2, 4}) : mesh(std::move(shape)) {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        curvature = estimator.estimate(mesh.vertices, {true, 1});
        normals = estimator.normals();
        neighbors = build_face_neighbors(mesh.faces, mesh.vertex_count());
        view.camera = fit_camera(mesh, direction, 1);
        view.width = view.height = k_size;
        view.unit_depth = view.camera.position().norm();
        view.feature_size = feature_size(mesh.vertices, curvature);
    }
    LineSurface surface() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors}; }
};

/// Bumps and hollows that hide parts of each other.
TriangleMesh knobbly(int subdivisions) {
    return shapes::transformed(shapes::icosphere(subdivisions, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.35f * std::sin(4 * p.x() + 1) * std::cos(3.5f * p.y()) + 0.15f * std::sin(5 * p.z()));
    });
}

Drawing draw(const Scene& scene, const DrawingStyle& style, std::span<const LineType> types = k_line_types) {
    return draw_lines(scene.surface(), types, style, scene.view);
}

/// Depths of the nearest surface at pixel centers, by the plainest of rasterizers.
FloatImage depth_picture(const Scene& scene) {
    FloatImage image(k_size, k_size, 1, 1.0f);
    for (const Face& face : scene.mesh.faces) {
        std::array<Vec3, 3> p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = scene.view.camera.project(scene.mesh.vertices[face[i]], k_size, k_size);
        const auto cross = [](const Vec3& a, const Vec3& b, double x, double y) {
            return (double(b.x()) - double(a.x())) * (y - double(a.y())) -
                   (double(b.y()) - double(a.y())) * (x - double(a.x()));
        };
        const double area = cross(p[0], p[1], double(p[2].x()), double(p[2].y()));
        if (area == 0) continue;
        const int left = int(std::min({p[0].x(), p[1].x(), p[2].x()})),
                  top = int(std::min({p[0].y(), p[1].y(), p[2].y()}));
        const int right = int(std::max({p[0].x(), p[1].x(), p[2].x()})),
                  bottom = int(std::max({p[0].y(), p[1].y(), p[2].y()}));
        for (int y = std::max(top, 0); y <= std::min(bottom, k_size - 1); ++y)
            for (int x = std::max(left, 0); x <= std::min(right, k_size - 1); ++x) {
                std::array<double, 3> w;
                for (std::size_t i = 0; i < 3; ++i)
                    w[i] = cross(p[(i + 1) % 3], p[(i + 2) % 3], x + 0.5, y + 0.5) / area;
                if (std::min({w[0], w[1], w[2]}) < 0) continue;
                float& depth = image.pixel(x, y)[0];
                depth = std::min(depth, static_cast<float>(w[0] * double(p[0].z()) + w[1] * double(p[1].z()) +
                                                           w[2] * double(p[2].z())));
            }
    }
    return image;
}

/// View-space depth of what Camera::project gives.
double linear_depth(const Camera& camera, float depth) {
    return double(camera.projection(2, 3)) / (double(depth) + double(camera.projection(2, 2)));
}

/// Whether a point of a drawing is in front of all pixels around it, or behind all; nothing if they do not agree.
std::optional<bool> is_in_front(const Scene& scene, const FloatImage& depths, const Vec2& at, float depth,
                                double slack) {
    const double own = linear_depth(scene.view.camera, depth);
    bool before = true, behind = true;
    for (int dy : {-1, 0, 1})
        for (int dx : {-1, 0, 1}) {
            const int x = int(std::floor(at.x())) + dx, y = int(std::floor(at.y())) + dy;
            if (x < 0 || y < 0 || x >= k_size || y >= k_size) return std::nullopt;
            const double there = linear_depth(scene.view.camera, depths.pixel(x, y)[0]);
            before = before && own < there + slack;
            behind = behind && own > there + slack;
        }
    return before == behind ? std::nullopt : std::optional(before);
}

struct HiddenLineErrors {
    double certain = 0, wrong = 0, hidden = 0;  // pixels of lines
};
void add_errors(const Scene& scene, const FloatImage& depths, const Drawing& drawing, double slack,
                HiddenLineErrors& errors) {
    for (const DrawingLayer& layer : drawing.layers)
        for (const Stroke& stroke : layer.strokes)
            for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
                const StrokePoint &a = stroke.points[i], &b = stroke.points[i + 1];
                const auto front =
                    is_in_front(scene, depths, 0.5f * (a.position + b.position), 0.5f * (a.depth + b.depth), slack);
                if (!front) continue;
                const double length = double((b.position - a.position).norm());
                errors.certain += length;
                errors.hidden += *front ? 0 : length;
                errors.wrong += *front != a.visible ? length : 0;
            }
}

TEST(Drawings, HideWhatAPictureOfDepthsHides) {
    DrawingStyle style = load_style("ink");
    HiddenLineErrors errors;
    for (const Vec3& direction : {Vec3(3, 2, 4), Vec3(-1, 4, 2), Vec3(2, -3, -3)}) {
        const Scene scene(knobbly(5), direction);
        const FloatImage depths = depth_picture(scene);
        // An edge is 0.03 long: contours lie so far behind the outline of the polygons.
        add_errors(scene, depths, draw(scene, style), 0.06, errors);
    }
    const Scene torus(shapes::torus(3, 1, 120, 40), {3, 1, 1});
    add_errors(torus, depth_picture(torus), draw(torus, style), 0.3, errors);
    const Scene boxes(
        shapes::joined(shapes::box(1, 1, 1, 4), shapes::translated(shapes::box(1, 2, 1, 2), {0.4f, 0, -3})));
    constexpr std::array k_edges = {LineType::creases, LineType::boundaries};
    add_errors(boxes, depth_picture(boxes), draw(boxes, style, k_edges), 0.02, errors);
    EXPECT_GT(errors.certain, 8000);
    EXPECT_GT(errors.hidden, 1500);
    EXPECT_LT(errors.wrong, 0.01 * errors.certain);
}

TEST(Drawings, KeepTheirLayersInOrder) {
    const Scene scene(knobbly(3));
    const Drawing drawing = draw(scene, load_style("ink"));
    ASSERT_EQ(drawing.layers.size(), k_line_types.size());
    for (std::size_t i = 0; i < drawing.layers.size(); ++i) EXPECT_EQ(drawing.layers[i].type, drawing_order()[i]);
    EXPECT_EQ(drawing.layers.back().type, LineType::contours);
    EXPECT_TRUE(draw(scene, load_style("ink"), {}).layers.empty());
}

TEST(Drawings, OfACutCubeHaveItsOutlineAndNothingElseAsContours) {
    const Scene cube(shapes::box(1, 1, 1, 3));
    const SplitSurface split = split_at_creases(cube.mesh.faces, cube.mesh.vertices, cube.neighbors, 0.7f);
    const std::vector<Vec3> positions = split.positions(cube.mesh.vertices);
    CurvatureEstimator estimator(split.faces, positions.size());
    const VertexCurvature& curvature = estimator.estimate(positions, {});
    const LineSurface cut{split.faces, positions, estimator.normals(), curvature, cube.neighbors},
        edges = cube.surface();
    const std::array types = {LineType::creases, LineType::contours, LineType::boundaries};
    const Drawing drawing = draw_lines(cut, types, load_style("technical"), cube.view, &edges);
    // Of a cube's nine visible edges six are its outline, three meet in front; three more are hidden.
    const auto visible = [](const DrawingLayer& layer) {
        std::size_t runs = 0;
        for (const Stroke& stroke : layer.strokes) runs += visible_runs(stroke).size();
        return runs;
    };
    ASSERT_EQ(drawing.layers.size(), 3);
    EXPECT_EQ(drawing.layers[0].type, LineType::creases);
    EXPECT_EQ(visible(drawing.layers[0]), 3);
    EXPECT_EQ(visible(drawing.layers[1]), 0);  // the cuts are no boundaries
    EXPECT_EQ(drawing.layers[2].type, LineType::contours);
    EXPECT_EQ(drawing.layers[2].segments, 6 * 3);
    EXPECT_EQ(visible(drawing.layers[2]), 1);  // around it, as at its corners two of them meet
}

TEST(VisibleRuns, AreWhatIsVisible) {
    Stroke stroke;
    for (int i = 0; i < 7; ++i) {
        stroke.points.emplace_back();
        stroke.points.back().position = Vec2(static_cast<float>(i), 0);
        stroke.points.back().parameter = static_cast<float>(i);
        stroke.points.back().visible = i != 2;
    }
    auto runs = visible_runs(stroke);
    ASSERT_EQ(runs.size(), 2);
    EXPECT_EQ(length_of(runs[0]), 2);
    EXPECT_EQ(length_of(runs[1]), 3);
    EXPECT_EQ(runs[1].points.front().parameter, 3);
    stroke.closed = true;  // the second run goes on in the first
    runs = visible_runs(stroke);
    ASSERT_EQ(runs.size(), 1);
    EXPECT_EQ(length_of(runs[0]), 5);
    EXPECT_FALSE(runs[0].closed);
    stroke.points[2].visible = true;
    runs = visible_runs(stroke);
    ASSERT_EQ(runs.size(), 1);
    EXPECT_TRUE(runs[0].closed);
    EXPECT_EQ(runs[0].points.size(), 7);
    for (StrokePoint& point : stroke.points) point.visible = false;
    EXPECT_TRUE(visible_runs(stroke).empty());
    EXPECT_TRUE(visible_runs({}).empty());
}

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
    return fs::path(testing::TempDir()) / name;
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

LineStyle black() {
    LineStyle style;
    style.color = {0, 0, 0};
    return style;
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

Stroke straight(const Vec2& a, const Vec2& b, float width) {
    Stroke stroke;
    for (const Vec2& p : {a, b}) {
        StrokePoint& point = stroke.points.emplace_back();
        point.position = p;
        point.width = width;
        point.normal = Vec2(-(b - a).y(), (b - a).x()).normalized();
    }
    stroke.points.back().parameter = (b - a).norm();
    return stroke;
}

TEST(StrokePictures, CoverWhatTheFormulaSays) {
    FloatImage image(20, 10, 3, 1.0f);
    const Stroke stroke = straight({4, 5.25f}, {16, 5.25f}, 3);
    draw_strokes({&stroke, 1}, black(), {}, image);
    for (int y = 0; y < 10; ++y) {
        const float distance = std::abs(static_cast<float>(y) + 0.5f - 5.25f);
        EXPECT_NEAR(image.pixel(10, y)[0], 1 - std::clamp(2 - distance, 0.0f, 1.0f), 1e-5) << y;
    }
    EXPECT_EQ(image.pixel(1, 5)[0], 1);
}

TEST(StrokePictures, DrawAStrokeOnceAndStrokesInOrder) {
    LineStyle style = black();
    style.opacity = 0.5f;
    Stroke back_and_forth = straight({2, 5}, {18, 5}, 4);
    back_and_forth.points.push_back(back_and_forth.points.front());
    FloatImage image(20, 10, 3, 1.0f);
    draw_strokes({&back_and_forth, 1}, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 0.5, 1e-6);
    const std::vector<Stroke> twice(2, back_and_forth);
    image = FloatImage(20, 10, 3, 1.0f);
    draw_strokes(twice, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 0.25, 1e-6);
    Stroke hidden = straight({2, 5}, {18, 5}, 4);
    hidden.points[0].visible = false;
    draw_strokes({&hidden, 1}, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 0.25, 1e-6);
}

TEST(StrokePictures, KeepTransparencyStraight) {
    FloatImage image(20, 10, 4, 0.0f);
    LineStyle style = black();
    style.color = {255, 0, 0};
    style.opacity = 0.5f;
    const Stroke stroke = straight({2, 5}, {18, 5}, 4);
    draw_strokes({&stroke, 1}, style, {}, image);
    EXPECT_NEAR(image.pixel(10, 5)[0], 1, 1e-6);  // its color, not darkened by what is not there
    EXPECT_NEAR(image.pixel(10, 5)[3], 0.5, 1e-6);
    EXPECT_EQ(image.pixel(1, 1)[3], 0);
    FloatImage gray(4, 4, 1);
    EXPECT_THROW(draw_strokes({&stroke, 1}, style, {}, gray), UsageError);
}

TEST(StrokePictures, LayTexturesAlongAndAcross) {
    // The right side of the way on, below, is opaque in every other 4 pixels.
    Image texture(8, 2, 1, 0);
    for (int x = 0; x < 4; ++x) texture.pixel(x, 1)[0] = 255;
    FloatImage image(40, 20, 3, 1.0f);
    const Stroke stroke = straight({4, 10}, {36, 10}, 12);
    draw_strokes({&stroke, 1}, black(), texture, image);
    for (int period = 0; period < 4; ++period) {
        EXPECT_NEAR(image.pixel(4 + 8 * period + 2, 14)[0], 0, 1e-5);
        EXPECT_NEAR(image.pixel(4 + 8 * period + 6, 14)[0], 1, 1e-5);
        EXPECT_NEAR(image.pixel(4 + 8 * period + 2, 5)[0], 1, 1e-5);
    }
}

TEST(DrawingsSideBySide, KeepWhatBothShow) {
    Stroke stroke;
    stroke.points = {{.position = {1, 2}}, {.position = {3, 4}, .visible = false}};
    const Drawing one{.width = 10,
                      .height = 8,
                      .layers = {{LineType::ridges, 1, {stroke}}, {LineType::contours, 2, {stroke}}},
                      .seconds = {}};
    const Drawing both = side_by_side(one, one);
    EXPECT_EQ(both.width, 20);
    EXPECT_EQ(both.height, 8);
    ASSERT_EQ(both.layers.size(), 2u);
    EXPECT_EQ(both.layers[1].segments, 4u);
    ASSERT_EQ(both.layers[1].strokes.size(), 2u);
    EXPECT_EQ(both.layers[1].strokes[0].points[1].position, Vec2(3, 4));
    EXPECT_EQ(both.layers[1].strokes[1].points[1].position, Vec2(13, 4));
    EXPECT_FALSE(both.layers[1].strokes[1].points[1].visible);
}

TEST(DrawingsSideBySide, MustBeAlike) {
    const Drawing ridges{.width = 10, .height = 8, .layers = {{LineType::ridges, 0, {}}}, .seconds = {}};
    const Drawing contours{.width = 10, .height = 8, .layers = {{LineType::contours, 0, {}}}, .seconds = {}};
    const Drawing higher{.width = 10, .height = 9, .layers = {{LineType::ridges, 0, {}}}, .seconds = {}};
    EXPECT_THROW(side_by_side(ridges, contours), UsageError);
    EXPECT_THROW(side_by_side(ridges, higher), UsageError);
    EXPECT_THROW(side_by_side(ridges, {.width = 10, .height = 8, .layers = {}, .seconds = {}}), UsageError);
}

}  // namespace
}  // namespace exemplar
