#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "gpu/hatching/pixel_projection.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/hatching/features/pixel_projection.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"

// Scalars: a sum of three products with weights up to 1, each rounded, and the weights themselves: 1e-6 of the largest
// value is 17 roundings. Directions: angles are off by what rounding moves a vector across, over its length; where
// terms cancel out, the sum of their magnitudes counts. View-dependent curvature: the unit vector to the eye is known
// to some 1e-7, so that results may differ by as much as the reference's do when the eye moves by as much, and by the
// rounding of sums of terms as large as the curvatures.
namespace exemplar {
namespace {

using test_support::random_vec3;
using test_support::shared_device;
using test_support::strip;

constexpr float k_scalar_tolerance = 1e-6f;
constexpr double k_epsilon = 0x1p-24;
constexpr double k_roundings = 16;
const std::initializer_list<std::size_t> k_odd_point_counts{0, 1, 2, 3, 4, 5, 63, 64, 65, 255, 256, 257, 1003};

FacePoints random_points(const TriangleMesh& mesh, std::size_t count, Random& random) {
    FacePoints points;
    for (std::size_t i = 0; i < count; ++i) {
        points.face.push_back(static_cast<std::uint32_t>(random.index(mesh.face_count())));
        auto b = static_cast<float>(random.uniform()), c = static_cast<float>(random.uniform());
        if (b + c > 1) {
            b = 1 - b;
            c = 1 - c;
        }
        if (random.uniform() < 0.1) b = 0;
        if (random.uniform() < 0.1) c = 1 - b;
        points.barycentric.push_back({b, c});
    }
    return points;
}

FeatureMatrix random_values(std::size_t rows, std::size_t columns, Random& random) {
    FeatureMatrix values;
    values.rows = rows;
    for (std::size_t k = 0; k < columns; ++k) {
        const double size = std::pow(10, random.uniform(-6, 6));
        for (float& value : values.add("test." + std::to_string(k))) value = static_cast<float>(size * random.normal());
    }
    return values;
}

std::vector<std::uint32_t> all_columns(std::size_t count) {
    std::vector<std::uint32_t> which;
    for (std::uint32_t k = 0; k < count; ++k) which.push_back(k);
    return which;
}

std::vector<float> scalars(PixelProjection& projection, const TriangleMesh& mesh, const FacePoints& points,
                           const FeatureMatrix& values, const std::vector<std::uint32_t>& which) {
    std::vector<float> out(which.size() * points.size(), -1);
    projection.scalars(mesh, points, values, which, out);
    return out;
}

void expect_scalar_parity(PixelProjection& device, const TriangleMesh& mesh, const FacePoints& points,
                          const FeatureMatrix& values, const std::vector<std::uint32_t>& which) {
    CpuPixelProjection host;
    const std::vector<float> expected = scalars(host, mesh, points, values, which);
    const std::vector<float> actual = scalars(device, mesh, points, values, which);
    for (std::size_t k = 0; k < which.size(); ++k)
        for (std::size_t i = 0; i < points.size(); ++i) {
            float largest = 0;
            for (const std::uint32_t v : mesh.faces[points.face[i]])
                largest = std::max(largest, std::abs(values.column(which[k])[v]));
            ASSERT_NEAR(actual[k * points.size() + i], expected[k * points.size() + i], k_scalar_tolerance * largest)
                << "column " << which[k] << ", point " << i;
        }
}

TEST(PixelProjectionParity, ScalarsOfOddNumbersOfPoints) {
    GpuPixelProjection projection(shared_device());
    Random random(1);
    const TriangleMesh mesh = strip(65);
    const FeatureMatrix values = random_values(65, 5, random);
    for (const std::size_t count : k_odd_point_counts) {
        SCOPED_TRACE(count);
        expect_scalar_parity(projection, mesh, random_points(mesh, count, random), values, all_columns(5));
    }
}

TEST(PixelProjectionParity, ScalarsOfOddNumbersOfColumnsAndVertices) {
    GpuPixelProjection projection(shared_device());
    Random random(2);
    for (const std::size_t vertices : {3u, 63u, 64u, 1025u})
        for (const std::size_t columns : {0u, 1u, 3u, 4u, 31u, 32u, 33u, 110u}) {
            SCOPED_TRACE(::testing::Message() << vertices << " vertices, " << columns << " columns");
            const TriangleMesh mesh = strip(vertices);
            expect_scalar_parity(projection, mesh, random_points(mesh, 67, random),
                                 random_values(vertices, columns, random), all_columns(columns));
        }
}

TEST(PixelProjectionParity, AnyColumnsInAnyOrderAndTwice) {
    GpuPixelProjection projection(shared_device());
    Random random(3);
    const TriangleMesh mesh = shapes::icosphere(2, 1);
    const FeatureMatrix values = random_values(mesh.vertex_count(), 75, random);
    const FacePoints points = random_points(mesh, 131, random);
    for (const std::vector<std::uint32_t>& which :
         {std::vector<std::uint32_t>{}, {74}, {40, 3, 39}, {5, 5, 70, 5, 0, 70}})
        expect_scalar_parity(projection, mesh, points, values, which);
    std::vector<std::uint32_t> shuffled = all_columns(75);
    random.shuffle(shuffled);
    shuffled.resize(60);
    expect_scalar_parity(projection, mesh, points, values, shuffled);
}

TEST(PixelProjectionParity, PointsAreTiled) {
    Random random(4);
    const TriangleMesh mesh = strip(40);
    const FeatureMatrix values = random_values(40, 37, random);
    const FacePoints points = random_points(mesh, 333, random);
    for (const std::size_t tile : {1u, 64u, 100u, 333u, 336u}) {
        SCOPED_TRACE(tile);
        GpuPixelProjection projection(shared_device(), nullptr, tile, 1);
        expect_scalar_parity(projection, mesh, points, values, all_columns(37));
    }
}

// What stays on the device is known by its contents, not by where it lies.
TEST(PixelProjectionParity, SeesWhatChangedInPlace) {
    GpuPixelProjection projection(shared_device());
    Random random(5);
    TriangleMesh mesh = strip(100);
    FeatureMatrix values = random_values(100, 40, random);
    const FacePoints points = random_points(mesh, 50, random);
    expect_scalar_parity(projection, mesh, points, values, all_columns(40));
    values.column(39)[0] += 1;
    values.column(3)[99] = 7;
    expect_scalar_parity(projection, mesh, points, values, all_columns(40));
    std::swap(mesh.faces[0][0], mesh.faces[0][2]);
    expect_scalar_parity(projection, mesh, points, values, all_columns(40));
    // The same values as twice as many columns of half as many rows.
    const TriangleMesh half = strip(50);
    FeatureMatrix other;
    other.rows = 50;
    for (std::size_t k = 0; k < 80; ++k) other.add("test");
    other.values = values.values;
    expect_scalar_parity(projection, half, random_points(half, 50, random), other, all_columns(80));
}

struct Fields {
    std::vector<std::vector<Vec3>> values;
    std::vector<std::span<const Vec3>> spans() const { return {values.begin(), values.end()}; }
};

/// Tangent to nothing, of lengths from tiny to large; one in ten is zero.
Fields random_vertex_fields(std::size_t vertices, std::size_t count, Random& random) {
    Fields fields;
    for (std::size_t k = 0; k < count; ++k) {
        auto& field = fields.values.emplace_back();
        const auto size = static_cast<float>(std::pow(10, random.uniform(-4, 4)));
        for (std::size_t v = 0; v < vertices; ++v)
            field.push_back(random.uniform() < 0.1 ? Vec3::Zero() : Vec3(size * random_vec3(random)));
    }
    return fields;
}

/// By how much the doubled angle of a field at a point may be off: what rounding moves the projected vector by, with
/// all terms of the sums it is made of taken as magnitudes, over its length. Two, all there is, where a sign is not
/// known.
double direction_tolerance(const TriangleMesh& mesh, const HatchingView& view, const FacePoints& points, std::size_t i,
                           std::span<const Vec3> field) {
    const Face& face = mesh.faces[points.face[i]];
    const auto& [b, c] = points.barycentric[i];
    const std::array<double, 3> weight{1.0 - double{b} - double{c}, double{b}, double{c}};
    std::array<Vec3d, 3> direction;
    for (std::size_t k = 0; k < 3; ++k) direction[k] = field[face[k]].cast<double>();
    const Vec3d leading = direction[0].squaredNorm() > 0 ? direction[0] : direction[1];
    Vec3d point = Vec3d::Zero(), around = Vec3d::Zero(), sum = Vec3d::Zero(), all = Vec3d::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
        const double dot = leading.dot(direction[k]);
        if (std::abs(dot) < 1e-6 * leading.norm() * direction[k].norm()) return 2;
        const Vec3d vertex = mesh.vertices[face[k]].cast<double>();
        point += weight[k] * vertex;
        around += std::abs(weight[k]) * vertex.cwiseAbs();
        sum += (dot < 0 ? -weight[k] : weight[k]) * direction[k];
        all += std::abs(weight[k]) * direction[k].cwiseAbs();
    }
    const Eigen::Matrix4d clip = view.camera.view_projection().cast<double>(), sizes = clip.cwiseAbs();
    const Eigen::Vector4d at = clip * point.homogeneous(), way = clip.leftCols<3>() * sum,
                          at_size = sizes * around.homogeneous(), way_size = sizes.leftCols<3>() * all;
    const Eigen::Vector2d scale(view.width, view.height);
    const Eigen::Vector2d there = (way.head<2>() * at.w() - at.head<2>() * way.w()).cwiseProduct(scale);
    const Eigen::Vector2d size =
        (way_size.head<2>() * at_size.w() + at_size.head<2>() * way_size.w()).cwiseProduct(scale);
    if (!(there.norm() > 0)) return 2;
    return std::min(2.0, 1e-6 + 2 * k_roundings * k_epsilon * size.norm() / there.norm());
}

/// Returns the share of directions that are known to 1e-4.
double expect_direction_parity(PixelProjection& device, const TriangleMesh& mesh, const HatchingView& view,
                               const FacePoints& points, const Fields& fields) {
    const std::size_t count = fields.values.size() * points.size();
    std::vector<DoubledAngle> expected(count), actual(count, {-1, -1});
    CpuPixelProjection().directions(mesh, view, points, fields.spans(), expected);
    device.directions(mesh, view, points, fields.spans(), actual);
    std::size_t known = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t field = k / points.size(), point = k % points.size();
        const auto length = static_cast<double>(std::hypot(actual[k][0], actual[k][1]));
        EXPECT_NEAR(length, expected[k] == DoubledAngle{} ? 0 : 1, 1e-5) << "field " << field << ", point " << point;
        const double tolerance = direction_tolerance(mesh, view, points, point, fields.values[field]);
        known += tolerance < 1e-4;
        const double apart = std::sqrt(static_cast<double>(squared_distance(actual[k], expected[k])));
        EXPECT_LE(apart, tolerance) << "field " << field << ", point " << point;
        if (::testing::Test::HasFailure()) break;
    }
    return count ? static_cast<double>(known) / static_cast<double>(count) : 1;
}

HatchingView view_of(const TriangleMesh& mesh, const Vec3& from, int width, int height, float fov = 0.4f) {
    HatchingView view;
    view.camera = fit_camera(mesh, from, static_cast<float>(width) / static_cast<float>(height), {.vertical_fov = fov});
    view.width = width;
    view.height = height;
    return view;
}

TEST(PixelProjectionParity, DirectionsOfOddNumbersOfPointsAndFields) {
    GpuPixelProjection projection(shared_device());
    Random random(6);
    const TriangleMesh mesh = shapes::torus(2, 0.7f, 13, 9);
    const HatchingView view = view_of(mesh, {1, 2, 3}, 170, 101);
    for (const std::size_t count : k_odd_point_counts) {
        SCOPED_TRACE(count);
        const FacePoints points = random_points(mesh, count, random);
        expect_direction_parity(projection, mesh, view, points, random_vertex_fields(mesh.vertex_count(), 5, random));
    }
    for (const std::size_t fields : {0u, 1u, 3u, 4u, 19u}) {
        SCOPED_TRACE(::testing::Message() << fields << " fields");
        const FacePoints points = random_points(mesh, 77, random);
        expect_direction_parity(projection, mesh, view, points,
                                random_vertex_fields(mesh.vertex_count(), fields, random));
    }
}

TEST(PixelProjectionParity, DirectionsInViewsOfAllKinds) {
    GpuPixelProjection projection(shared_device(), nullptr, 500);
    Random random(7);
    for (const float size : {1e-3f, 1.0f, 1e3f})
        for (const float fov : {0.0f, 0.4f, 1.5f})
            for (const auto& [width, height] : {std::pair(300, 40), std::pair(64, 64), std::pair(33, 200)}) {
                SCOPED_TRACE(::testing::Message() << size << ", " << fov << ", " << width);
                const TriangleMesh mesh = shapes::rotated(shapes::icosphere(2, size), shapes::random_rotation(3));
                const HatchingView view = view_of(mesh, random_vec3(random), width, height, fov);
                const FacePoints points = random_points(mesh, 1500, random);
                EXPECT_GT(expect_direction_parity(projection, mesh, view, points,
                                                  random_vertex_fields(mesh.vertex_count(), 3, random)),
                          0.9);
            }
}

TEST(PixelProjectionParity, FieldsWithoutDirectionsHaveNoneInThePicture) {
    GpuPixelProjection gpu(shared_device());
    CpuPixelProjection cpu;
    Random random(8);
    const TriangleMesh mesh = strip(30);
    const HatchingView view = view_of(mesh, {0, 0, 1}, 50, 50, 0);
    const FacePoints points = random_points(mesh, 90, random);
    // No direction at all; directions straight to the eye of a parallel projection.
    const Fields fields{{std::vector<Vec3>(30, Vec3::Zero()), std::vector<Vec3>(30, Vec3::UnitZ())}};
    for (PixelProjection* projection : std::initializer_list<PixelProjection*>{&gpu, &cpu}) {
        std::vector<DoubledAngle> out(180, {1, 1});
        projection->directions(mesh, view, points, fields.spans(), out);
        EXPECT_EQ(out, std::vector<DoubledAngle>(180));
    }
}

// Without sign, whatever corner comes first, and whichever corners have a direction.
TEST(PixelProjectionParity, SignsOfDirectionsDoNotCount) {
    GpuPixelProjection gpu(shared_device());
    CpuPixelProjection cpu;
    Random random(9);
    const TriangleMesh mesh = strip(64);
    const HatchingView view = view_of(mesh, {0.3f, 0.2f, 1}, 80, 60);
    const FacePoints points = random_points(mesh, 200, random);
    Fields plain, flipped;
    const Vec3 direction(-0.6f, -0.5f, -0.2f);
    auto& first = plain.values.emplace_back(64, direction);
    auto& second = flipped.values.emplace_back(64, direction);
    for (std::size_t v = 0; v < 64; ++v) {
        if (v % 5 < 2) first[v] = second[v] = Vec3::Zero();
        if (random.uniform() < 0.5) second[v] *= -1;
    }
    for (PixelProjection* projection : std::initializer_list<PixelProjection*>{&gpu, &cpu}) {
        std::vector<DoubledAngle> one(200), other(200);
        projection->directions(mesh, view, points, plain.spans(), one);
        projection->directions(mesh, view, points, flipped.spans(), other);
        for (std::size_t i = 0; i < 200; ++i) ASSERT_LT(squared_distance(one[i], other[i]), 1e-8f) << "point " << i;
    }
}

/// A surface of any curvature: flat, umbilic, saddles of equal curvatures, and all between, over six orders.
HatchingSurface random_surface(std::size_t vertices, Random& random) {
    HatchingSurface surface;
    surface.mesh = strip(vertices);
    surface.unit = 3.7f;
    for (std::size_t v = 0; v < vertices; ++v) surface.normals.push_back(random_vec3(random).normalized());
    for (VertexCurvature& c : surface.curvature)
        for (std::size_t v = 0; v < vertices; ++v) {
            const double size = std::pow(10, random.uniform(-3, 3)), kind = random.uniform();
            auto k1 = static_cast<float>(size * random.normal()), k2 = static_cast<float>(size * random.normal());
            if (kind < 0.05) k1 = k2 = 0;
            if (kind > 0.95) k2 = -k1;
            c.k1.push_back(std::max(k1, k2));
            c.k2.push_back(std::min(k1, k2));
            const Vec3& n = surface.normals[v];
            c.e1.push_back(n.cross(random_vec3(random)).normalized());
            c.e2.push_back(n.cross(c.e1.back()));
            std::array<float, 4> derivative{};
            for (float& d : derivative) d = static_cast<float>(size * size * random.normal());
            c.derivative.push_back(derivative);
        }
    return surface;
}

/// The vertices themselves as points.
FacePoints vertex_points(const TriangleMesh& mesh) {
    FacePoints points{std::vector<std::uint32_t>(mesh.vertex_count()),
                      std::vector<std::array<float, 2>>(mesh.vertex_count())};
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            points.face[mesh.faces[f][k]] = f;
            points.barycentric[mesh.faces[f][k]] = {k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f};
        }
    return points;
}

/// V x 90: what the reference changes by when the eye moves by 3e-7 of its distance, and the rounding of sums.
FeatureMatrix curvature_tolerance(const HatchingSurface& surface, const HatchingView& view) {
    const FeatureMatrix base = view_curvature_features(surface, view);
    FeatureMatrix tolerance = base;
    for (std::size_t k = 0; k < base.cols(); ++k) {
        const VertexCurvature& c = surface.curvature[k / (2 * k_curvature_functions)];
        const std::size_t function = k / 2 % k_curvature_functions;
        const bool second_order = function == 1 || (function >= 6 && function <= 9) || function == 11;
        for (std::size_t v = 0; v < base.rows; ++v) {
            const float first = std::max(std::abs(c.k1[v]), std::abs(c.k2[v])) * surface.unit;
            float second = first * first;
            for (const float d : c.derivative[v]) second = std::max(second, std::abs(d) * surface.unit * surface.unit);
            tolerance.column(k)[v] = 1e-6f * std::max(second_order ? second : first, std::abs(base.column(k)[v]));
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        HatchingView moved = view;
        moved.camera.view(axis, 3) += 3e-7f * view.camera.view.col(3).head<3>().norm();
        Eigen::Matrix3f turn = Eigen::AngleAxisf(3e-7f, Vec3::Unit(axis)).toRotationMatrix();
        moved.camera.view.topLeftCorner<3, 3>() = turn * view.camera.view.topLeftCorner<3, 3>();
        const FeatureMatrix other = view_curvature_features(surface, moved);
        for (std::size_t i = 0; i < base.values.size(); ++i)
            tolerance.values[i] += 4 * std::abs(other.values[i] - base.values[i]);
    }
    return tolerance;
}

TEST(PixelProjectionParity, ViewCurvatureOfOddNumbersOfVertices) {
    GpuPixelProjection projection(shared_device());
    Random random(10);
    for (const std::size_t vertices : {3u, 63u, 64u, 65u, 2001u})
        for (const float fov : {0.0f, 0.4f}) {
            SCOPED_TRACE(::testing::Message() << vertices << " vertices, " << fov);
            const HatchingSurface surface = random_surface(vertices, random);
            const HatchingView view = view_of(surface.mesh, random_vec3(random), 100, 100, fov);
            const FeatureMatrix expected = view_curvature_features(surface, view);
            const FeatureMatrix tolerance = curvature_tolerance(surface, view);
            std::vector<float> actual(expected.values.size());
            projection.curvature(surface, view, vertex_points(surface.mesh), all_columns(k_view_curvature_columns),
                                 actual);
            for (std::size_t i = 0; i < actual.size(); ++i)
                ASSERT_NEAR(actual[i], expected.values[i], tolerance.values[i])
                    << expected.names[i / vertices] << " of vertex " << i % vertices;
        }
}

TEST(PixelProjectionParity, ViewCurvatureAtPointsOfSomeColumns) {
    GpuPixelProjection projection(shared_device(), nullptr, 64);
    Random random(11);
    const HatchingSurface surface = random_surface(300, random);
    const HatchingView view = view_of(surface.mesh, {1, 2, 3}, 100, 100);
    const FacePoints points = random_points(surface.mesh, 257, random);
    const std::vector<std::uint32_t> which{89, 0, 31, 59, 60, 0, 29, 30};
    const FeatureMatrix tolerance = curvature_tolerance(surface, view);
    std::vector<float> expected(which.size() * 257), actual(expected.size()), allowed(expected.size());
    CpuPixelProjection().curvature(surface, view, points, which, expected);
    CpuPixelProjection().scalars(surface.mesh, points, tolerance, which, allowed);
    projection.curvature(surface, view, points, which, actual);
    for (std::size_t i = 0; i < actual.size(); ++i)
        ASSERT_NEAR(actual[i], expected[i], 2 * allowed[i] + 1e-6f * std::abs(expected[i])) << i;
}

TEST(PixelProjectionParity, RerunsAndOthersBetweenThemChangeNothing) {
    GpuPixelProjection projection(shared_device(), nullptr, 200), fresh(shared_device());
    Random random(12);
    const HatchingSurface surface = random_surface(400, random), other = random_surface(77, random);
    const HatchingView view = view_of(surface.mesh, {1, 2, 3}, 100, 100);
    const FacePoints points = random_points(surface.mesh, 501, random);
    const FeatureMatrix values = random_values(400, 50, random);
    const Fields fields = random_vertex_fields(400, 7, random);
    struct Results {
        std::vector<float> scalars, curvature;
        std::vector<DoubledAngle> directions;
        bool operator==(const Results&) const = default;
    };
    const auto run = [&](PixelProjection& with) {
        Results results{scalars(with, surface.mesh, points, values, all_columns(50)), std::vector<float>(90 * 501),
                        std::vector<DoubledAngle>(7 * 501)};
        with.curvature(surface, view, points, all_columns(90), results.curvature);
        with.directions(surface.mesh, view, points, fields.spans(), results.directions);
        return results;
    };
    const Results first = run(projection);
    const FacePoints elsewhere = random_points(other.mesh, 33, random);
    std::vector<float> ignored(90 * 33);
    projection.curvature(other, view_of(other.mesh, {3, 1, 1}, 20, 20), elsewhere, all_columns(90), ignored);
    EXPECT_TRUE(run(projection) == first);
    EXPECT_TRUE(run(fresh) == first);
}

TEST(PixelProjectionParity, RefusesWhatTheReferenceRefuses) {
    GpuPixelProjection gpu(shared_device());
    CpuPixelProjection cpu;
    Random random(13);
    const HatchingSurface surface = random_surface(20, random);
    const TriangleMesh& mesh = surface.mesh;
    const HatchingView view = view_of(mesh, {0, 0, 1}, 10, 10);
    const FeatureMatrix values = random_values(20, 3, random), short_of = random_values(19, 3, random);
    const FacePoints good = random_points(mesh, 5, random);
    FacePoints beyond = good, uneven = good;
    beyond.face[2] = static_cast<std::uint32_t>(mesh.face_count());
    uneven.barycentric.pop_back();
    TriangleMesh torn = mesh;
    torn.faces[1][1] = 20;
    HatchingSurface unmeasured = surface;
    unmeasured.curvature[1].derivative.clear();
    const Fields fields = random_vertex_fields(20, 2, random), few = random_vertex_fields(19, 2, random);
    std::vector<float> out(10), small(9);
    std::vector<DoubledAngle> doubled(10), less(9);
    const std::vector<std::uint32_t> which{0, 2}, missing{0, 3}, no_curvature{0, 90};
    for (PixelProjection* p : std::initializer_list<PixelProjection*>{&gpu, &cpu}) {
        EXPECT_THROW(p->scalars(mesh, beyond, values, which, out), UsageError);
        EXPECT_THROW(p->scalars(mesh, uneven, values, which, out), UsageError);
        EXPECT_THROW(p->scalars(torn, good, values, which, out), UsageError);
        EXPECT_THROW(p->scalars(mesh, good, short_of, which, out), UsageError);
        EXPECT_THROW(p->scalars(mesh, good, values, missing, out), UsageError);
        EXPECT_THROW(p->scalars(mesh, good, values, which, small), UsageError);
        EXPECT_THROW(p->curvature(unmeasured, view, good, which, out), UsageError);
        EXPECT_THROW(p->curvature(surface, view, good, no_curvature, out), UsageError);
        EXPECT_THROW(p->directions(mesh, view, good, few.spans(), doubled), UsageError);
        EXPECT_THROW(p->directions(mesh, view, good, fields.spans(), less), UsageError);
        EXPECT_NO_THROW(p->scalars(mesh, good, values, which, out));
    }
}

// The reference is faster than kernels on the same cores.
TEST(PixelProjectionParity, DevicesGetTheFastestProjection) {
    const std::unique_ptr<PixelProjection> projection = projection_for(shared_device());
    EXPECT_EQ(dynamic_cast<CpuPixelProjection*>(projection.get()) != nullptr, shared_device().host_is_faster());
    Random random(9);
    const TriangleMesh mesh = strip(65);
    expect_scalar_parity(*projection, mesh, random_points(mesh, 67, random), random_values(65, 5, random),
                         all_columns(5));
}

}  // namespace
}  // namespace exemplar
