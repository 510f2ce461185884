// Pixel features of hatching, evaluation of a style, and placement of strokes.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "apps/bench/kernels/surfaces.h"
#include "embedded/hatching_claim_comp.h"
#include "embedded/hatching_directions_comp.h"
#include "embedded/hatching_end_round_comp.h"
#include "embedded/hatching_orientations_comp.h"
#include "embedded/hatching_place_comp.h"
#include "embedded/hatching_project_comp.h"
#include "embedded/hatching_property_comp.h"
#include "embedded/hatching_seed_comp.h"
#include "embedded/hatching_trace_comp.h"
#include "embedded/hatching_view_curvature_comp.h"
#include "gpu/hatching/hatching_evaluator.h"
#include "gpu/hatching/pixel_projection.h"
#include "gpu/hatching/stroke_placer.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/placement/streamlines.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {
namespace {

FacePoints random_points(const TriangleMesh& mesh, std::size_t count, Random& random) {
    FacePoints points;
    for (std::size_t i = 0; i < count; ++i) {
        points.face.push_back(static_cast<std::uint32_t>(random.index(mesh.face_count())));
        const auto b = static_cast<float>(random.uniform());
        points.barycentric.push_back({b, (1 - b) * static_cast<float>(random.uniform())});
    }
    return points;
}

// A column per name, of standard normal values.
FeatureMatrix normal_values(std::size_t rows, std::size_t columns, Random& random) {
    FeatureMatrix values;
    values.rows = rows;
    for (std::size_t k = 0; k < columns; ++k)
        for (float& value : values.add(std::to_string(k))) value = static_cast<float>(random.normal());
    return values;
}

std::vector<std::uint32_t> first_columns(std::size_t count) {
    std::vector<std::uint32_t> which;
    for (std::uint32_t k = 0; k < count; ++k) which.push_back(k);
    return which;
}

// Makes a surface with all that curvature at pixels depends on; the rest is empty.
HatchingSurface measured(const TriangleMesh& mesh) {
    HatchingSurface surface;
    surface.mesh = mesh;
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    const VertexCurvature curvature = estimator.estimate(mesh.vertices, {.derivatives = true});
    surface.curvature.fill(curvature);
    surface.normals = estimator.normals();
    return surface;
}

// Scalars, view-dependent curvature and directions at points of a surface, ten per face.
struct Projecting {
    static constexpr std::size_t k_scalars = 32, k_fields = 12;

    Projecting(Device& device, Profiler& profiler, std::size_t count)
        : mesh(wavy_torus(static_cast<std::uint32_t>(std::max<std::size_t>(count / 20, 64)))),
          surface(measured(mesh)),
          points(random_points(mesh, count, random)),
          values(normal_values(mesh.vertex_count(), k_scalars, random)),
          view{.camera = fit_camera(mesh, Vec3(0.3f, 0.8f, 1), 1), .width = 1000, .height = 1000},
          actual(count),
          projection(device, &profiler) {
        for (std::size_t k = 0; k < k_fields; ++k) fields.push_back(k % 2 ? surface.curvature[0].e1 : surface.normals);
    }
    struct Results {
        explicit Results(std::size_t count)
            : scalars(k_scalars * count), curvature(k_view_curvature_columns * count), directions(k_fields * count) {}
        std::vector<float> scalars, curvature;
        std::vector<DoubledAngle> directions;
    };
    void project(PixelProjection& with, Results& results) const {
        const std::vector<std::span<const Vec3>> spans(fields.begin(), fields.end());
        with.scalars(mesh, points, values, first_columns(k_scalars), results.scalars);
        with.curvature(surface, view, points, first_columns(k_view_curvature_columns), results.curvature);
        with.directions(mesh, view, points, spans, results.directions);
    }
    void run() { project(projection, actual); }
    std::vector<Difference> differences() const {
        Results expected(points.size());
        CpuPixelProjection reference;
        project(reference, expected);
        return {{"scalars", largest_difference(actual.scalars, expected.scalars), 1e-5},
                {"share of curvatures off by a thousandth", share_off(actual.curvature, expected.curvature), 1e-3},
                {"share of directions off by a thousandth",
                 share_off(flat(actual.directions), flat(expected.directions)), 1e-2}};
    }
    // Compares by shares, as view-dependent curvature is unstable where the eye is along a normal, and directions
    // are where terms cancel out.
    static double share_off(std::span<const float> a, std::span<const float> b) {
        std::size_t off = 0;
        for (std::size_t i = 0; i < a.size(); ++i) off += !(std::abs(a[i] - b[i]) <= 1e-3f * (1 + std::abs(b[i])));
        return static_cast<double>(off) / static_cast<double>(a.size());
    }
    static std::vector<float> flat(std::span<const DoubledAngle> directions) {
        std::vector<float> values;
        for (const DoubledAngle& d : directions) values.insert(values.end(), d.begin(), d.end());
        return values;
    }
    // Columns are in quads: 8 of scalars and 23 of curvature in 1 + 3 slabs; directions in 3 slabs of 4. Each pass
    // reads the face, the barycentrics and the corners of a point.
    std::map<std::string, Work> work() const {
        const auto count = static_cast<double>(points.size()), vertices = static_cast<double>(mesh.vertex_count()),
                   faces = static_cast<double>(mesh.face_count());
        constexpr double k_quads = 8 + 23, k_slabs = 1 + 3;
        return {{"hatching/project.comp",
                 {.bytes = 16 * k_quads * (count + vertices) + k_slabs * (12 * count + 16 * faces),
                  .operations = count * k_quads * 4 * 5}},
                {"hatching/view_curvature.comp",
                 {.bytes = vertices * (3 * 80 + 4.0 * k_view_curvature_columns), .operations = vertices * 3 * 150}},
                {"hatching/directions.comp",
                 {.bytes = count * 8 * k_fields + vertices * 16 * (k_fields + 3) + 3 * (12 * count + 16 * faces),
                  .operations = count * k_fields * 60}}};
    }
    Random random{7};
    TriangleMesh mesh;
    HatchingSurface surface;
    FacePoints points;
    FeatureMatrix values;
    HatchingView view;
    std::vector<std::vector<Vec3>> fields;
    Results actual;
    GpuPixelProjection projection;
};

// A style of five segments with rules of six terms, and a property of 24 terms, the largest that learning gives.
struct StyleEvaluation {
    static constexpr std::size_t k_segments = 5, k_rule_terms = 6, k_property_terms = 24, k_columns = 12;

    StyleEvaluation(Device& device, Profiler& profiler, std::size_t rows)
        : fields(rows),
          segment(rows),
          which(first_columns(k_columns)),
          features(normal_values(rows, k_columns, random)),
          evaluator(device, &profiler) {
        for (DoubledAngle& v : fields.values) v = doubled_angle(static_cast<float>(random.uniform(0, 3.1)));
        for (std::int32_t& s : segment) s = static_cast<std::int32_t>(random.index(k_segments));
        for (std::size_t s = 0; s < k_segments; ++s) {
            OrientationFunction& function = functions.emplace_back();
            // One term outweighs the others together, so that no sum is close to zero.
            for (std::size_t k = 0; k < k_rule_terms; ++k)
                function.terms.push_back({static_cast<std::uint32_t>(random.index(k_orientation_features)),
                                          k == 0 ? 1.0f : static_cast<float>(random.uniform(-0.15, 0.15))});
        }
        for (std::size_t k = 0; k < k_property_terms; ++k)
            model.terms.push_back({.feature = static_cast<std::uint32_t>(random.index(k_columns) * k_powers),
                                   .a = 0.2f,
                                   .b = 1,
                                   .exponent = static_cast<float>(random.uniform(-0.3, 0.3)),
                                   .low = -2,
                                   .high = 2,
                                   .least = 0.05f});
    }
    void run() {
        directions = evaluator.orientations(functions, segment, fields);
        properties = evaluator.property(model, which, features);
    }
    std::vector<Difference> differences() const {
        CpuHatchingEvaluator reference;
        return {{"directions",
                 largest_difference(Projecting::flat(directions),
                                    Projecting::flat(reference.orientations(functions, segment, fields))),
                 1e-5},
                {"properties", largest_difference(properties, reference.property(model, which, features)), 1e-4}};
    }
    std::map<std::string, Work> work() const {
        const auto rows = static_cast<double>(segment.size());
        return {{"hatching/orientations.comp",
                 {.bytes = rows * (4 + 8 * k_rule_terms + 8), .operations = rows * (4 * k_rule_terms + 5)}},
                {"hatching/property.comp",
                 {.bytes = rows * 4 * (k_columns + 1), .operations = rows * (8 * k_property_terms + 1)}}};
    }
    Random random{8};
    OrientationFields fields;
    std::vector<std::int32_t> segment;
    std::vector<std::uint32_t> which;
    FeatureMatrix features;
    std::vector<OrientationFunction> functions;
    PropertyModel model;
    std::vector<DoubledAngle> directions;
    std::vector<float> properties;
    GpuHatchingEvaluator evaluator;
};

// Makes fields of two layers of bent strokes, with targets that differ everywhere.
HatchingFields waves(int side) {
    HatchingFields fields(side, side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::size_t i = fields.index(x, y);
            const float along = std::sin(static_cast<float>(x) / 70), down = std::cos(static_cast<float>(y) / 90);
            fields.level[i] = along + down > 0.3f ? k_cross_hatching : k_single_hatching;
            fields.orientation[0][i] = 1.2f + 0.5f * (along + down);
            fields.orientation[1][i] = fields.orientation[0][i] * 0.5f;
            fields.spacing[i] = 5 + down;
            fields.length[i] = 50 * (1 + 0.3f * along);
            fields.thickness[i] = 1;
            fields.intensity[i] = 1;
        }
    return fields;
}

struct Placement {
    Placement(Device& device, Profiler& profiler, std::size_t pixels)
        : fields(waves(static_cast<int>(std::lround(std::sqrt(static_cast<double>(pixels)))))),
          placer(device, &profiler) {}
    void run() { strokes = placer.place(fields); }
    std::vector<Difference> differences() const {
        const std::vector<HatchStroke> expected = CpuStrokePlacer().place(fields);
        std::size_t other = std::max(strokes.size(), expected.size()) - std::min(strokes.size(), expected.size());
        for (std::size_t i = 0; i < std::min(strokes.size(), expected.size()); ++i) other += strokes[i] != expected[i];
        return {{"strokes that differ", static_cast<double>(other), 0}};
    }
    // Counts only the strokes that are placed, as the number of rejected seeds and streamlines is not known. Pixels,
    // of 16 bytes, and clearance, of 4 bytes a layer, are read once. A stroke claims and marks about a spacing to
    // both sides of each of its pixels.
    std::map<std::string, Work> work() const {
        double points = 0;
        for (const HatchStroke& stroke : strokes) points += static_cast<double>(stroke.points.size());
        const auto count = static_cast<double>(strokes.size()), pixels = static_cast<double>(fields.size());
        constexpr double k_around = 8;
        return {{"hatching/seed.comp", {.bytes = count * 2 * 15 * 16, .operations = count * 2 * 200}},
                {"hatching/trace.comp", {.bytes = pixels * 24 + points * 8, .operations = points * 200}},
                {"hatching/claim.comp",
                 {.bytes = points * (8 + 2 * k_around * 4), .operations = points * 2 * k_around * 6}},
                {"hatching/end_round.comp", {.bytes = count * (48 + 3 * 16 + 16), .operations = count * 40}},
                {"hatching/place.comp", {.bytes = points * (16 + k_around * 4), .operations = points * k_around * 10}}};
    }
    HatchingFields fields;
    std::vector<HatchStroke> strokes;
    GpuStrokePlacer placer;
};

}  // namespace

std::vector<OperationKind> hatching_operations() {
    return {
        {"projection to pixels",
         "points",
         {20'000, 100'000, 400'000},
         {&shaders::hatching_project_comp, &shaders::hatching_view_curvature_comp, &shaders::hatching_directions_comp},
         {},
         prepare_as<Projecting>},
        {"style evaluation",
         "rows",
         {20'000, 100'000, 400'000},
         {&shaders::hatching_orientations_comp, &shaders::hatching_property_comp},
         {},
         prepare_as<StyleEvaluation>},
        {"stroke placement",
         "pixels",
         {65'536, 262'144},
         {&shaders::hatching_seed_comp, &shaders::hatching_trace_comp, &shaders::hatching_claim_comp,
          &shaders::hatching_end_round_comp, &shaders::hatching_place_comp},
         {},
         prepare_as<Placement>}};
}

}  // namespace exemplar
