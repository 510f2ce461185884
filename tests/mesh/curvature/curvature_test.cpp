#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "host/core/parallel.h"
#include "host/mesh/curvature/curvature.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// What differential geometry says at a point: principal curvatures, the first principal direction (either sign), and
/// the derivative for that sign of it.
struct Truth {
    double k1, k2;
    Vec3d e1;
    std::array<double, 4> derivative;
};
/// The truth at a vertex, or nothing where the surface has a boundary or umbilic nearby.
using TruthAt = std::function<std::optional<Truth>(const Vec3d&)>;

struct Errors {
    double curvature = 0, direction = 0, derivative = 0;
};

/// Largest errors over the vertices where the truth is known.
Errors largest_errors(const TriangleMesh& mesh, const TruthAt& truth_at) {
    const VertexCurvature c = estimate_curvature(mesh, true);
    Errors errors;
    std::size_t compared = 0;
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        const std::optional<Truth> truth = truth_at(mesh.vertices[i].cast<double>());
        if (!truth) continue;
        ++compared;
        errors.curvature = std::max({errors.curvature, std::abs(c.k1[i] - truth->k1), std::abs(c.k2[i] - truth->k2)});
        const double along = c.e1[i].cast<double>().dot(truth->e1), sign = along > 0 ? 1 : -1;
        errors.direction = std::max(errors.direction, 1 - std::abs(along));
        // Turning both axes around turns the sign of all four components.
        for (std::size_t k = 0; k < 4; ++k)
            errors.derivative = std::max(errors.derivative, std::abs(sign * c.derivative[i][k] - truth->derivative[k]));
    }
    EXPECT_GT(compared, mesh.vertex_count() / 4);
    return errors;
}

/// Refining by two divides second-order errors by four. (Much finer meshes would show the rounding of their float
/// coordinates instead: over the edge length cubed it goes into the derivative.)
void expect_second_order(const std::function<TriangleMesh(std::uint32_t)>& mesh, const TruthAt& truth_at,
                         Errors limit) {
    Errors coarse = largest_errors(mesh(10), truth_at);
    for (std::uint32_t n : {20u, 40u}) {
        const Errors fine = largest_errors(mesh(n), truth_at);
        EXPECT_LT(fine.curvature, coarse.curvature / 3.3) << n;
        EXPECT_LT(fine.derivative, coarse.derivative / 3.0) << n;
        coarse = fine;
    }
    EXPECT_LT(coarse.curvature, limit.curvature);
    EXPECT_LT(coarse.direction, limit.direction);
    EXPECT_LT(coarse.derivative, limit.derivative);
}

TEST(Curvature, OfATorusConvergesToTheTruth) {
    constexpr double k_ring = 3, k_tube = 1;
    expect_second_order([](std::uint32_t n) { return shapes::torus(k_ring, k_tube, 2 * n, n); },
                        [](const Vec3d& p) -> std::optional<Truth> {
                            // Around the tube 1 / its radius; along the ring cos(v) / w. Only the latter changes, along
                            // the tube.
                            const double w = std::hypot(p.x(), p.y()), cosine = (w - k_ring) / k_tube,
                                         sine = p.z() / k_tube;
                            const Vec3d tube(-sine * p.x() / w, -sine * p.y() / w, cosine);
                            return Truth{1 / k_tube, cosine / w, tube, {0, 0, -k_ring * sine / (k_tube * w * w), 0}};
                        },
                        {4e-3, 1e-5, 6e-3});
}

TEST(Curvature, OfAnEllipsoidConvergesToTheTruth) {
    // Of revolution, radius 1, half-height 1.6, without the poles: parallels are curved most.
    constexpr double k_radius = 1, k_half_height = 1.6;
    const auto mesh = [](std::uint32_t n) {
        const TriangleMesh cylinder = shapes::cylinder(1, 2, 3 * n, n, false);
        return shapes::transformed(cylinder, [](const Vec3& p) {
            const double latitude = p.z();
            return shapes::detail::vec3(k_radius * std::cos(latitude) * double(p.x()),
                                        k_radius * std::cos(latitude) * double(p.y()),
                                        k_half_height * std::sin(latitude));
        });
    };
    const auto truth_at = [](const Vec3d& p) -> std::optional<Truth> {
        const double sine = p.z() / k_half_height, cosine = std::sqrt(1 - sine * sine);
        if (std::abs(sine) > 0.6) return std::nullopt;
        const double speed = std::sqrt(k_radius * k_radius * sine * sine +
                                       k_half_height * k_half_height * cosine * cosine);  // ds over d latitude
        const double stretch =
            (k_radius * k_radius - k_half_height * k_half_height) * sine * cosine / (speed * speed);  // d speed over ds
        const Vec3d parallel = Vec3d(-p.y(), p.x(), 0).normalized();  // with the outward normal, e2 runs to the north
        return Truth{k_half_height / (k_radius * speed),
                     k_radius * k_half_height / (speed * speed * speed),
                     parallel,
                     {0, -k_half_height / (k_radius * speed * speed) * stretch, 0,
                      -3 * k_radius * k_half_height / std::pow(speed, 4) * stretch}};
    };
    expect_second_order(mesh, truth_at, {4e-3, 1e-5, 6e-3});
}

TEST(Curvature, OfASaddleHasBothSigns) {
    // z = (x^2 - 2 y^2) / 2 over a grid, normals up: hollow along x, convex along y.
    const auto mesh = shapes::transformed(shapes::grid(80, 80, 0.2f), [](const Vec3& p) {
        const double x = double(p.x()) - 0.1, y = double(p.y()) - 0.1;
        return shapes::detail::vec3(x, y, (x * x - 2 * y * y) / 2);
    });
    const VertexCurvature c = estimate_curvature(mesh, false);
    const std::size_t middle = 40 * 81 + 40;
    EXPECT_NEAR(c.k1[middle], 2, 0.01);
    EXPECT_NEAR(c.k2[middle], -1, 0.01);
    EXPECT_NEAR(std::abs(c.e1[middle].y()), 1, 1e-4);
    EXPECT_TRUE(c.derivative.empty());
}

TEST(Curvature, OfASphereIsExactOnAnyMeshOfIt) {
    TriangleMesh mesh = shapes::icosphere(3, 1);
    Random random(4);
    for (Vec3& p : mesh.vertices) {
        for (int i = 0; i < 3; ++i) p[i] += static_cast<float>(random.uniform(-0.03, 0.03));
        p = 2 * p.normalized();
    }
    const VertexCurvature c = estimate_curvature(mesh, true);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        EXPECT_NEAR(c.k1[i], 0.5, 1e-4);
        EXPECT_NEAR(c.k2[i], 0.5, 1e-4);
        for (float d : c.derivative[i]) EXPECT_NEAR(d, 0, 2e-3);
    }
}

TEST(Curvature, OfACylinderIsItsRadiusAndZero) {
    const TriangleMesh mesh = shapes::cylinder(2, 6, 32, 24, false);
    const VertexCurvature c = estimate_curvature(mesh, true);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        EXPECT_NEAR(c.k1[i], 0.5, 1e-5);
        EXPECT_NEAR(c.k2[i], 0, 1e-5);
        EXPECT_NEAR(std::abs(c.e2[i].z()), 1, 1e-5);
        for (float d : c.derivative[i]) EXPECT_NEAR(d, 0, 1e-4);
    }
}

TEST(Curvature, OfAPlaneIsZero) {
    const TriangleMesh mesh = shapes::rotated(shapes::grid(9, 7, 3), shapes::random_rotation(1));
    const VertexCurvature c = estimate_curvature(mesh, true);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        EXPECT_NEAR(c.k1[i], 0, 1e-5);
        EXPECT_NEAR(c.k2[i], 0, 1e-5);
    }
}

/// A mesh without symmetry, of uneven triangles.
TriangleMesh lumpy() {
    return shapes::transformed(shapes::icosphere(4, 1), [](const Vec3& p) -> Vec3 {
        return p * (1 + 0.2f * std::sin(3 * p.x() + 1) + 0.15f * p.y() * std::cos(4 * p.z()));
    });
}

TEST(Curvature, FramesAreOrthonormalAndOrdered) {
    const TriangleMesh mesh = lumpy();
    const VertexCurvature c = estimate_curvature(mesh, false);
    const std::vector<Vec3> normals = vertex_normals(mesh);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        EXPECT_GE(c.k1[i], c.k2[i]);
        EXPECT_LT((c.e1[i].cross(c.e2[i]) - normals[i]).norm(), 1e-5);
        EXPECT_NEAR(c.e1[i].norm(), 1, 1e-5);
        EXPECT_NEAR(c.e1[i].dot(c.e2[i]), 0, 1e-5);
    }
}

/// Compares two estimates of one surface whose units of length differ by `scale`, where directions are well defined.
void expect_same_up_to(const VertexCurvature& a, const VertexCurvature& b, const Eigen::Matrix3f& rotation,
                       float scale) {
    std::size_t compared = 0;
    for (std::size_t i = 0; i < a.k1.size(); ++i) {
        EXPECT_NEAR(a.k1[i], b.k1[i] * scale, 1e-3);
        EXPECT_NEAR(a.k2[i], b.k2[i] * scale, 1e-3);
        if (a.k1[i] - a.k2[i] < 0.2f) continue;
        ++compared;
        const float along = (rotation * a.e1[i]).dot(b.e1[i]), sign = along > 0 ? 1.0f : -1.0f;
        EXPECT_NEAR(std::abs(along), 1, 1e-3);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(a.derivative[i][k], sign * b.derivative[i][k] * scale * scale,
                        0.01 + 0.01 * std::abs(a.derivative[i][k]));
    }
    EXPECT_GT(compared, a.k1.size() / 4);
}

TEST(Curvature, MovesWithRigidMotions) {
    const Eigen::Matrix3f rotation = shapes::random_rotation(6);
    const TriangleMesh moved = shapes::translated(shapes::rotated(lumpy(), rotation), {0.3f, -0.2f, 0.5f});
    expect_same_up_to(estimate_curvature(lumpy(), true), estimate_curvature(moved, true), rotation, 1);
}

TEST(Curvature, ScalesInversely) {
    const Eigen::Matrix3f identity = Eigen::Matrix3f::Identity();
    for (const float scale : {1e-4f, 1e3f})
        expect_same_up_to(estimate_curvature(lumpy(), true), estimate_curvature(shapes::scaled(lumpy(), scale), true),
                          identity, scale);
}

TEST(Curvature, DoesNotDependOnFaceOrder) {
    expect_same_up_to(estimate_curvature(lumpy(), true),
                      estimate_curvature(shapes::with_shuffled_faces(lumpy(), 3), true), Eigen::Matrix3f::Identity(),
                      1);
}

TEST(Curvature, TurnedInsideOutChangesSignAndOrder) {
    TriangleMesh inverted = lumpy();
    for (Face& face : inverted.faces) std::swap(face[0], face[1]);
    const VertexCurvature a = estimate_curvature(lumpy(), false), b = estimate_curvature(inverted, false);
    for (std::size_t i = 0; i < a.k1.size(); ++i) {
        EXPECT_NEAR(a.k1[i], -b.k2[i], 1e-4);
        EXPECT_NEAR(a.k2[i], -b.k1[i], 1e-4);
    }
}

TEST(Curvature, DoesNotDependOnThreads) {
    const TriangleMesh mesh = shapes::torus(3, 1, 150, 60);
    const VertexCurvature many = estimate_curvature(mesh, true);
    const ThreadLimit limit(1);
    const VertexCurvature one = estimate_curvature(mesh, true);
    EXPECT_EQ(many.k1, one.k1);
    EXPECT_EQ(many.derivative, one.derivative);
}

TEST(Curvature, WeighsFacesByVoronoiArea) {
    // Two isosceles triangles on the edge V W, one acute, one obtuse at its far corner, bent about the edge. The
    // normals at V and W are equal, so each face bends only across the edge: by the sine between that normal and its
    // own, over its height. V takes their mean by its cells.
    constexpr double k_acute = 1.5, k_obtuse = 0.4, k_half_edge = 1;
    TriangleMesh mesh;
    mesh.vertices = {{0, k_half_edge, 0},
                     {0, -k_half_edge, 0},
                     {-k_acute, 0, 0},
                     shapes::detail::vec3(k_obtuse * 0.96, 0, -k_obtuse * 0.28)};
    mesh.faces = {{0, 2, 1}, {1, 3, 0}};
    const Vec3d at_edge = vertex_normals(mesh)[0].cast<double>();
    const double bend[] = {at_edge.cross(Vec3d(0, 0, 1)).norm() / k_acute,
                           at_edge.cross(Vec3d(0.28, 0, 0.96)).norm() / k_obtuse};
    const auto leg_squared = [](double height) { return k_half_edge * k_half_edge + height * height; };
    // Acute: V, W share what the far corner's cell, two right triangles on half a leg, leaves them.
    const double circumradius = leg_squared(k_acute) / (2 * k_acute);
    const double far_cell =
        std::sqrt(leg_squared(k_acute)) / 2 * std::sqrt(circumradius * circumradius - leg_squared(k_acute) / 4);
    const double cell[] = {(k_half_edge * k_acute - far_cell) / 2, leg_squared(k_obtuse) / 8 * k_obtuse / k_half_edge};
    const double expected = (cell[0] * bend[0] + cell[1] * bend[1]) / (cell[0] + cell[1]);
    const VertexCurvature c = estimate_curvature(mesh, false);
    for (std::size_t v : {0, 1}) {
        EXPECT_NEAR(c.k1[v], expected, 1e-5);
        EXPECT_NEAR(c.k2[v], 0, 1e-5);
    }
}

TEST(Curvature, LeavesDegenerateFacesOut) {
    const TriangleMesh mesh = lumpy();
    TriangleMesh with_junk = mesh;
    with_junk.faces.push_back({7, 7, 7});
    for (std::uint32_t v = 0; v < 100; ++v)
        for (const Face& twice : {Face{v, v, v + 1}, Face{v, v + 1, v}, Face{v + 1, v, v}})
            with_junk.faces.push_back(twice);
    const auto lone = static_cast<std::uint32_t>(mesh.vertex_count());
    with_junk.vertices.insert(with_junk.vertices.end(), {{9, 9, 9}, {8, 8, 8}, {7, 7, 7}});
    with_junk.faces.push_back({lone, lone + 1, lone + 2});
    const VertexCurvature clean = estimate_curvature(mesh, true), junk = estimate_curvature(with_junk, true);
    for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        EXPECT_EQ(clean.k1[i], junk.k1[i]);
        EXPECT_EQ(clean.derivative[i], junk.derivative[i]);
    }
    for (std::size_t i = lone; i < lone + 3; ++i) {
        EXPECT_EQ(junk.k1[i], 0);
        EXPECT_EQ(junk.derivative[i], (std::array<float, 4>{}));
    }
}

TEST(Curvature, IsFiniteOnSliversOfEveryWidth) {
    const TriangleMesh mesh = lumpy();
    for (float width = 1; width > 1e-13f; width *= 0.6f) {
        TriangleMesh with_sliver = mesh;
        const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
        const Vec3 corner = mesh.vertices[0];
        with_sliver.vertices.insert(with_sliver.vertices.end(),
                                    {{0, 0, 0}, {1, width, 0}, {1, 0, 0}, {1, width, width}});
        with_sliver.vertices.push_back(corner + Vec3(width, 0, 0));
        with_sliver.faces.insert(with_sliver.faces.end(), {{first, first + 1, first + 2},
                                                           {first, first + 2, first + 3},
                                                           {first + 1, first + 3, first + 2},
                                                           {0, 1, first + 4}});
        const VertexCurvature c = estimate_curvature(with_sliver, true);
        for (std::size_t i = 0; i < with_sliver.vertex_count(); ++i) {
            ASSERT_TRUE(std::isfinite(c.k1[i]) && std::isfinite(c.k2[i])) << width << " at " << i;
            for (float d : c.derivative[i]) ASSERT_TRUE(std::isfinite(d)) << width << " at " << i;
        }
    }
}

TEST(Curvature, IsFiniteOnWildMeshes) {
    Random random(8);
    TriangleMesh mesh;
    for (int i = 0; i < 60; ++i)
        mesh.vertices.push_back(shapes::detail::vec3(random.normal(), random.normal(), 1e-6 * random.normal()));
    for (int i = 0; i < 400; ++i) {
        Face face;
        for (std::uint32_t& v : face) v = static_cast<std::uint32_t>(random.index(60));
        mesh.faces.push_back(face);
    }
    const VertexCurvature c = estimate_curvature(mesh, true);
    for (std::size_t i = 0; i < 60; ++i) {
        EXPECT_TRUE(std::isfinite(c.k1[i]) && std::isfinite(c.k2[i]) && c.e1[i].allFinite() && c.e2[i].allFinite());
        for (float d : c.derivative[i]) EXPECT_TRUE(std::isfinite(d));
    }
    EXPECT_TRUE(estimate_curvature({}, true).k1.empty());
}

}  // namespace
}  // namespace exemplar
