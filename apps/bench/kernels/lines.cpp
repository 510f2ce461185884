// A line drawing of a surface: all kernels from its curvature to strokes, with lines of all types.

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "apps/bench/kernels/surfaces.h"
#include "embedded/curvature_normals_comp.h"
#include "embedded/lines_apparent_ridges_comp.h"
#include "embedded/lines_count_comp.h"
#include "embedded/lines_fields_comp.h"
#include "embedded/lines_gather_comp.h"
#include "embedded/lines_jump_comp.h"
#include "embedded/lines_links_comp.h"
#include "embedded/lines_nodes_comp.h"
#include "embedded/lines_phases_comp.h"
#include "embedded/lines_points_comp.h"
#include "embedded/lines_rank_comp.h"
#include "embedded/lines_scan_comp.h"
#include "embedded/lines_segments_comp.h"
#include "embedded/lines_strokes_comp.h"
#include "embedded/lines_traces_comp.h"
#include "embedded/lines_view_curvature_comp.h"
#include "embedded/lines_visibility_comp.h"
#include "embedded/lines_votes_comp.h"
#include "embedded/lines_write_traces_comp.h"
#include "gpu/lines/cut_surface.h"
#include "gpu/lines/line_renderer.h"
#include "gpu/lines/segment_records.h"
#include "host/lines/extraction/face_neighbors.h"
#include "host/lines/strokes/chains.h"
#include "host/lines/strokes/coherence.h"
#include "host/lines/strokes/strokes.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {
namespace {

using shared::LineCounts;
using shared::LinePoint;
using shared::LineSegmentRecord;
using shared::vec4;

// Smaller for devices with few texels per binding.
int width_for(const Device& device) {
    return device.info().max_texels < 800 * 600 ? 280 : 800;
}

// Curvature as the host estimates it, so that both find lines on the same surface.
struct CurvedTorus {
    CurvedTorus(Device& device, std::size_t vertices)
        : mesh(wavy_torus(static_cast<std::uint32_t>(vertices))),
          neighbors(build_face_neighbors(mesh.faces, mesh.vertices)) {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        curvature = estimator.estimate(mesh.vertices, {.derivatives = true, .smoothing = 1});
        normals = estimator.normals();
        first = with_values(device, curvature.e1, curvature.k1);
        second = with_values(device, curvature.e2, curvature.k2);
        positions = uploaded(device, mesh.vertices);
        device_normals = uploaded(device, normals);
        std::vector<vec4> derivatives;
        for (const auto& [a, b, c, d] : curvature.derivative) derivatives.push_back({a, b, c, d});
        derivative = Buffer::of<vec4>(device, derivatives);
    }
    static Buffer with_values(Device& device, std::span<const Vec3> vectors, std::span<const float> values) {
        std::vector<vec4> both;
        for (std::size_t i = 0; i < vectors.size(); ++i)
            both.push_back({vectors[i].x(), vectors[i].y(), vectors[i].z(), values[i]});
        return Buffer::of<vec4>(device, both);
    }
    LineSurface surface() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors}; }
    GpuCurvedSurface snapshot() const { return {positions, device_normals, &first, &second, &derivative}; }

    TriangleMesh mesh;
    std::vector<FaceNeighbors> neighbors;
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    Buffer positions, device_normals, first, second, derivative;
};

LineThresholds low_thresholds() {
    LineThresholds thresholds;
    thresholds.principal_highlights = 0.001f;  // so that there are some
    return thresholds;
}

// No taper, so that hidden parts do not change a stroke.
constexpr StrokeThickness k_thickness{.taper = 0};

LinePicture picture_of(const CurvedTorus& torus, int width) {
    LinePicture picture;
    picture.view = {.camera = fit_camera(torus.mesh, Vec3(3.07f, 2.11f, 4.23f), 4.0f / 3),
                    .width = width,
                    .height = width * 3 / 4,
                    .unit_depth = 20,
                    .feature_size = feature_size(torus.mesh.vertices, torus.curvature)};
    picture.families = line_families(k_line_types);
    picture.thresholds = family_thresholds(low_thresholds());
    picture.looks = plain_looks(low_thresholds(), k_thickness);
    return picture;
}

// A drawing downloaded from the device.
struct Drawn {
    LineCounts counts{};
    std::vector<LineSegmentRecord> segments;
    std::vector<LinePoint> points;
    std::vector<vec4> strokes, traces;  // two a point; one a segment
};

Drawn download(const LineRenderer& renderer) {
    Drawn drawn;
    const GpuLineExtraction& lines = renderer.strokes().chains().lines();
    lines.counts().download(std::span(&drawn.counts, 1));
    drawn.segments.resize(drawn.counts.segments);
    lines.segments().download(std::span(drawn.segments));
    drawn.points.resize(drawn.counts.points);
    renderer.strokes().chains().points().download(std::span(drawn.points));
    drawn.strokes.resize(2 * drawn.points.size());
    renderer.strokes().strokes().download(std::span(drawn.strokes));
    drawn.traces.resize(drawn.segments.size());
    renderer.coherence().traces().download(std::span(drawn.traces));
    return drawn;
}

double share(std::size_t part, std::size_t of) {
    return of ? static_cast<double>(part) / static_cast<double>(of) : 0.0;
}

// Allows for faces that a line only touches: device and host may disagree on them.
Difference missing_segments(const Drawn& drawn, const CurvedTorus& torus, const StrokeView& view) {
    const LineOptions options{.eye = view.camera.position(),
                              .feature_size = view.feature_size,
                              .thresholds = low_thresholds(),
                              .no_creases_on_outline = true};
    using Key = std::tuple<std::uint32_t, std::uint8_t, SegmentEnd, SegmentEnd>;
    std::size_t wanted = 0, missing = 0;
    for (const LineType type : k_line_types) {
        std::set<Key> found;
        for (const LineSegment& s : segments_of_type(drawn.segments, type).segments)
            found.insert({s.face, s.family, s.places[0], s.places[1]});
        for (const LineSegment& s : extract_lines(torus.surface(), type, options)) {
            ++wanted;
            missing += !found.contains({s.face, s.family, s.places[0], s.places[1]});
        }
    }
    return {"share of segments that are missing", share(missing, wanted), 0.005};
}

// The reference's strokes of the device's own segments, in the order of the device: by a chain's first segment.
std::vector<StrokePoint> expected_points(const Drawn& drawn, const CurvedTorus& torus, const StrokeView& view) {
    std::map<std::uint32_t, Stroke> by_start;
    for (const LineType type : k_line_types) {
        const ReadSegments own = segments_of_type(drawn.segments, type);
        const std::vector<Chain> chains = chain_segments(torus.mesh.faces, torus.neighbors, own.segments);
        std::vector<Stroke> strokes =
            make_strokes(torus.surface(), type, own.segments, chains, nullptr, view, low_thresholds(), k_thickness);
        for (std::size_t i = 0; i < chains.size(); ++i)
            by_start[own.numbers[chains[i].links[0].segment]] = std::move(strokes[i]);
    }
    std::vector<StrokePoint> points;
    for (const auto& [start, stroke] : by_start)
        points.insert(points.end(), stroke.points.begin(), stroke.points.end());
    return points;
}

void compare_strokes(const Drawn& drawn, std::span<const StrokePoint> expected, std::vector<Difference>& differences) {
    std::vector<float> places, widths, opacities, wanted_places, wanted_widths, wanted_opacities;
    for (std::size_t i = 0; i < drawn.points.size(); ++i) {
        const vec4& stroke = drawn.strokes[2 * i];
        places.insert(places.end(), {stroke.x, stroke.y});
        widths.push_back(stroke.z);
        opacities.push_back(stroke.w);
    }
    for (const StrokePoint& point : expected) {
        wanted_places.insert(wanted_places.end(), {point.position.x(), point.position.y()});
        wanted_widths.push_back(point.width);
        wanted_opacities.push_back(point.opacity);
    }
    differences.push_back({"points of strokes, pixels", largest_difference(places, wanted_places), 5e-3});
    differences.push_back({"widths, pixels", largest_difference(widths, wanted_widths), 1e-2});
    differences.push_back({"opacities", largest_difference(opacities, wanted_opacities), 1e-3});
}

// Returns the distance of two texture coordinates, modulo the period.
double apart(float a, float b) {
    const double turns = static_cast<double>(a - b) / shared::k_texture_width;
    return shared::k_texture_width * std::abs(turns - std::round(turns));
}

// Allows for lines that are equally near to two others, as they may follow either.
Difference moved_textures(const Drawn& before, const Drawn& now, const CurvedTorus& torus, const StrokeView& view) {
    std::size_t off = 0;
    for (const LineType type : k_line_types) {
        const ReadSegments then = segments_of_type(before.segments, type), own = segments_of_type(now.segments, type);
        std::vector<LineTrace> left;
        for (std::size_t i = 0; i < then.segments.size(); ++i) {
            const vec4& trace = before.traces[then.numbers[i]];
            left.push_back({then.segments[i].face, then.segments[i].family, then.segments[i].ends, {trace.x, trace.y}});
        }
        const std::vector<Chain> chains = chain_segments(torus.mesh.faces, torus.neighbors, own.segments);
        const auto textures = follow_traces(torus.surface(), own.segments, chains, left, view, shared::k_texture_width);
        const auto expected =
            trace_lines(torus.surface(), own.segments, chains, textures, view, shared::k_texture_width);
        for (std::size_t i = 0; i < own.segments.size(); ++i) {
            const vec4& trace = now.traces[own.numbers[i]];
            off += std::max(apart(trace.x, expected[i].texture[0]), apart(trace.y, expected[i].texture[1])) > 0.5;
        }
    }
    return {"share of textures off by half a pixel", share(off, now.segments.size()), 0.02};
}

struct LineDrawing {
    LineDrawing(Device& device, Profiler& profiler, std::size_t vertices)
        : torus(device, vertices),
          surface(device, torus.mesh),
          line_surface(surface),
          picture(picture_of(torus, width_for(device))),
          stream(device, &profiler),
          renderer(device, line_surface) {}
    void run() {
        renderer.record(stream, torus.snapshot(), picture);
        stream.finish();
    }
    std::vector<Difference> differences() {
        const Drawn before = download(renderer);
        run();
        const Drawn now = download(renderer);
        std::vector<Difference> differences{missing_segments(now, torus, picture.view)};
        compare_strokes(now, expected_points(now, torus, picture.view), differences);
        differences.push_back(moved_textures(before, now, torus, picture.view));
        return differences;
    }
    std::map<std::string, Work> work() const;

    CurvedTorus torus;
    GpuSurface surface;
    GpuLineSurface line_surface;
    LinePicture picture;
    Stream stream;
    LineRenderer renderer;
};

// Kernels over vertices and faces read each vertex' fields once: 8 families of a vec4, 5 with a direction. The
// comments of kernels over segments and points list what they read; data read by earlier kernels may come from
// caches. Each jump quadruples, so chains take half the log2 of their number of segments.
std::map<std::string, Work> LineDrawing::work() const {
    const Drawn drawn = download(renderer);
    const auto vertices = static_cast<double>(torus.mesh.vertex_count()),
               faces = static_cast<double>(torus.mesh.face_count()),
               segments = static_cast<double>(drawn.segments.size()), points = static_cast<double>(drawn.points.size());
    const double groups = (faces + segments) / shared::k_count_group, jumps = std::ceil(std::log2(segments + 1) / 2);
    constexpr double k_fields = 16 * (8 + 5);
    const double pixels = static_cast<double>(picture.view.width) * picture.view.height;
    const auto of = [](double count, double bytes, double operations) {
        return Work{.bytes = count * bytes, .operations = count * operations};
    };
    return {{"lines/view_curvature.comp", of(vertices, 64 + 16, 60)},
            {"lines/fields.comp", of(vertices, 80 + 16 * (7 + 4), 150)},
            {"lines/apparent_ridges.comp", of(vertices, 36 + 64 + 32, 6 * 30)},
            {"lines/count.comp", {.bytes = faces * 20 + vertices * k_fields, .operations = faces * 8 * 20}},
            {"lines/scan.comp", of(groups, 8, 2)},
            {"lines/segments.comp", {.bytes = faces * 4 + segments * (16 + 3 * 32 + 32), .operations = segments * 60}},
            {"lines/links.comp", of(segments, 32 + 16 + 3 * 16 + 16 + 32 + 8, 100)},
            {"lines/nodes.comp", of(2 * segments, 8 + 32 + 32, 5)},
            {"lines/jump.comp", of(2 * segments * jumps, 128 + 32, 12)},
            {"lines/rank.comp", of(segments, 64 + 16 + 4, 20)},
            {"lines/points.comp", of(segments, 16 + 32 + 32 + 32, 5)},
            {"lines/visibility.comp", {.bytes = points * (32 + 32 + 8) + 4 * pixels, .operations = points * 100}},
            {"lines/strokes.comp", of(points, 32 + 8 + 32 + 32, 100)},
            {"lines/traces.comp", of(segments, 32 + 16 + 32 + 20, 40)},
            {"lines/votes.comp", of(points, 64 + 32 + 12, 80)},
            {"lines/phases.comp", of(points, 32 + 32 + 8, 200)},
            {"lines/write_traces.comp", of(points, 128 + 16, 30)}};
}

// Every fourth vertex is cut into two.
SplitSurface split_of(const TriangleMesh& mesh) {
    SplitSurface split{mesh.faces, {}};
    const auto vertices = static_cast<std::uint32_t>(mesh.vertex_count());
    for (std::uint32_t v = 0; v < vertices; ++v) split.source.push_back(v);
    for (std::uint32_t v = 0; v < vertices; v += 4) split.source.push_back(v);
    return split;
}

struct CuttingOpen {
    CuttingOpen(Device& device, Profiler& profiler, std::size_t vertices)
        : torus(device, vertices),
          split(split_of(torus.mesh)),
          surface(device, torus.mesh),
          stream(device, &profiler),
          cut(surface, split, {}) {}
    void run() {
        cut.record(stream, torus.snapshot());
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<Vec3> directions;
        directions.reserve(split.source.size());
        for (const std::uint32_t v : split.source) directions.push_back(torus.curvature.e1[v]);
        const GpuCurvedSurface device = cut.snapshot();
        return {{"positions",
                 largest_difference(flattened(vectors_of(device.vertices), 1),
                                    flattened(split.positions(torus.mesh.vertices), 1)),
                 0},
                {"principal directions",
                 largest_difference(flattened(vectors_of(*device.first), 1), flattened(directions, 1)), 0}};
    }
    // Four vectors are gathered per vertex. Normals read a ring of six faces, as in estimated curvature.
    std::map<std::string, Work> work() const {
        const auto vertices = static_cast<double>(split.source.size());
        return {{"lines/gather.comp", {.bytes = vertices * 4 * (4 + 16 + 16), .operations = vertices * 4}},
                {"curvature/normals.comp", {.bytes = vertices * 68, .operations = vertices * 360}}};
    }

    CurvedTorus torus;
    SplitSurface split;
    GpuSurface surface;
    Stream stream;
    GpuCutSurface cut;
};

}  // namespace

std::vector<OperationKind> line_operations() {
    return {{"cutting open along edges",
             "vertices",
             {5'000, 20'000, 100'000},
             {&shaders::lines_gather_comp, &shaders::curvature_normals_comp},
             {},
             prepare_as<CuttingOpen>},
            {"line drawing",
             "vertices",
             {5'000, 20'000, 100'000},
             {&shaders::lines_view_curvature_comp, &shaders::lines_fields_comp, &shaders::lines_apparent_ridges_comp,
              &shaders::lines_count_comp, &shaders::lines_scan_comp, &shaders::lines_segments_comp,
              &shaders::lines_links_comp, &shaders::lines_nodes_comp, &shaders::lines_jump_comp,
              &shaders::lines_rank_comp, &shaders::lines_points_comp, &shaders::lines_visibility_comp,
              &shaders::lines_strokes_comp, &shaders::lines_traces_comp, &shaders::lines_votes_comp,
              &shaders::lines_phases_comp, &shaders::lines_write_traces_comp},
             {},
             prepare_as<LineDrawing>}};
}

}  // namespace exemplar
