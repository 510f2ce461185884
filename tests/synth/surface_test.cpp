#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "host/core/random.h"
#include "host/synth/modeling/field.h"
#include "host/synth/modeling/part_labels.h"
#include "host/synth/modeling/polygonize.h"
#include "host/synth/modeling/primitives.h"
#include "host/synth/modeling/remesh.h"
#include "host/synth/modeling/sculptor.h"

namespace exemplar {
namespace {

double area(const TriangleMesh& mesh) {
    const std::vector<float> areas = face_areas(mesh);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

long euler_characteristic(const TriangleMesh& mesh) {
    return static_cast<long>(mesh.vertex_count()) - static_cast<long>(mesh.face_count()) / 2;
}

std::vector<Solid> one_of_each() {
    return {RoundCone{0.6f, 0.3f, 0.1f},
            Ellipsoid{Vec3(0.5f, 0.3f, 0.4f)},
            RoundBox{Vec3(0.5f, 0.2f, 0.3f), 0.05f},
            RoundCylinder{0.4f, 0.3f, 0.05f},
            Torus{0.5f, 0.15f},
            Prism{{{-0.4f, -0.3f}, {0.5f, -0.2f}, {0.1f, 0.4f}}, 0.2f, 0.05f},
            Lathe{{{0.0f, 0.0f}, {0.4f, 0.0f}, {0.5f, 0.5f}}, {0.05f, 0.06f, 0.08f}},
            Tube{{Vec3(0, 0, 0), Vec3(0.3f, 0.2f, 0), Vec3(0.5f, 0.5f, 0.4f)}, {0.2f, 0.15f, 0.1f}}};
}

TEST(Primitives, DistancesAlongAnAxisAreExact) {
    EXPECT_FLOAT_EQ(solid_distance(RoundCone{1, 0.3f, 0.1f}, Vec3(0, -1, 0)), 0.7f);
    EXPECT_FLOAT_EQ(solid_distance(RoundCone{1, 0.3f, 0.1f}, Vec3(0, 2, 0)), 0.9f);
    EXPECT_FLOAT_EQ(solid_distance(RoundCone{1, 0.2f, 0.2f}, Vec3(0.5f, 0.4f, 0)), 0.3f);
    EXPECT_FLOAT_EQ(solid_distance(RoundBox{Vec3(1, 2, 3), 0.1f}, Vec3(1.5f, 0, 0)), 0.5f);
    EXPECT_FLOAT_EQ(solid_distance(RoundBox{Vec3(1, 2, 3), 0.1f}, Vec3(0, 0, 2.5f)), -0.5f);
    EXPECT_FLOAT_EQ(solid_distance(Torus{1, 0.25f}, Vec3(0, 0, 2)), 0.75f);
    EXPECT_FLOAT_EQ(solid_distance(Torus{1, 0.25f}, Vec3::Zero()), 0.75f);
    EXPECT_NEAR(solid_distance(RoundCylinder{1, 0.5f, 0.1f}, Vec3(0, 1.5f, 0)), 0.5f, 1e-6);
    EXPECT_NEAR(solid_distance(Ellipsoid{Vec3(1, 2, 3)}, Vec3(0, 2, 0)), 0, 1e-6);
    EXPECT_LT(solid_distance(Ellipsoid{Vec3(1, 2, 3)}, Vec3::Zero()), 0);
    const Prism square{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 0.5f, 0.1f};
    EXPECT_NEAR(solid_distance(square, Vec3(2, 0, 0)), 0.9f, 1e-6);
    EXPECT_NEAR(solid_distance(square, Vec3(0, 1, 0)), 0.4f, 1e-6);
    const Lathe cup{{{0, 0}, {1, 0}, {1, 2}}, {0.1f, 0.1f, 0.1f}};
    EXPECT_NEAR(solid_distance(cup, Vec3(0, 1, 0)), 0.9f, 1e-6);  // the middle of the hollow
    EXPECT_NEAR(solid_distance(cup, Vec3(0, 1, 1)), -0.1f, 1e-6);
}

TEST(Primitives, AreInsideTheirBoundingBallAndGrowAtMostAsFastAsDistance) {
    Random random(7);
    for (const Solid& solid : one_of_each()) {
        SCOPED_TRACE(solid.index());
        const Ball ball = bounding_ball(solid);
        const bool estimated = std::holds_alternative<Ellipsoid>(solid) || std::holds_alternative<Tube>(solid);
        for (int i = 0; i < 300; ++i) {
            const auto point = [&] {
                return Vec3(pick(random, -1.5f, 1.5f), pick(random, -1.5f, 1.5f), pick(random, -1.5f, 1.5f));
            };
            const Vec3 a = point(), b = point();
            const float da = solid_distance(solid, a), db = solid_distance(solid, b);
            if (da < 0) {
                EXPECT_LE((a - ball.center).norm(), ball.radius);
            }
            EXPECT_LE(std::abs(da - db), (estimated ? 1.6f : 1.0f) * (a - b).norm() + 1e-5f);
        }
    }
}

TEST(Field, ProjectionLandsOnTheSurfaceOfEveryPrimitive) {
    Random random(3);
    for (const Solid& solid : one_of_each()) {
        SCOPED_TRACE(solid.index());
        const ImplicitField field({Primitive{solid, 0, Vec3(0.1f, 0.2f, 0.3f), turn_x(30), Vec3(1, 1, 0.6f)}});
        int tried = 0;
        for (int i = 0; i < 2000 && tried < 40; ++i) {
            Vec3 p(pick(random, -1, 1), pick(random, -1, 1), pick(random, -1, 1));
            if (std::abs(field.value(p)) > 0.02f) continue;
            ++tried;
            field.project(p, 0.1f);
            EXPECT_NEAR(field.value(p), 0, 2e-3);
        }
        EXPECT_GT(tried, 5);
    }
}

TEST(Field, ActiveSubsetsGiveTheFullValueNearTheirPoint) {
    ShapeModel model;
    Sculptor add(model);
    Random random(5);
    for (int i = 0; i < 30; ++i) {
        add.blend(pick(random, 0, 0.1f));
        add.limb(Vec3(pick(random, -1, 1), pick(random, -1, 1), 0), Vec3(pick(random, -1, 1), 0, pick(random, -1, 1)),
                 0.1f, 0.05f);
    }
    const ImplicitField field(model.primitives);
    std::vector<std::uint32_t> all(field.size());
    std::iota(all.begin(), all.end(), 0u);
    for (int i = 0; i < 100; ++i) {
        const Vec3 center(pick(random, -1, 1), pick(random, -1, 1), pick(random, -1, 1));
        const auto near = field.active_near(center, 0.2f, all);
        const Vec3 p = center + Vec3(pick(random, -0.1f, 0.1f), pick(random, -0.1f, 0.1f), pick(random, -0.1f, 0.1f));
        EXPECT_NEAR(field.value(p, near), field.value(p), 1e-6);
        EXPECT_NEAR(field.value(p, all), field.value(p), 1e-6);
    }
}

TEST(Polygonize, SphereAndTorusHaveTheirAreaAndGenus) {
    const TriangleMesh sphere = polygonize(ImplicitField({Primitive{Ellipsoid{Vec3::Constant(0.5f)}}}), 0.05f);
    EXPECT_EQ(euler_characteristic(sphere), 2);
    EXPECT_NEAR(area(sphere), 3.14159, 0.05);
    const TriangleMesh torus = polygonize(ImplicitField({Primitive{Torus{0.5f, 0.2f}}}), 0.04f);
    EXPECT_EQ(euler_characteristic(torus), 0);
    EXPECT_NEAR(area(torus), 4 * 3.14159 * 3.14159 * 0.5 * 0.2, 0.06);
}

TEST(Remesh, KeepsAreaAndGenusAtTheWantedFaceCount) {
    const ImplicitField field({Primitive{Torus{0.5f, 0.2f}}});
    const TriangleMesh fine = polygonize(field, 0.03f);
    for (const std::size_t faces : {300u, 1000u, 1001u}) {
        const TriangleMesh mesh = remesh(fine, field, faces);
        EXPECT_EQ(mesh.face_count(), faces / 2 * 2);
        EXPECT_EQ(euler_characteristic(mesh), 0);
        EXPECT_NEAR(area(mesh), 4 * 3.14159 * 3.14159 * 0.5 * 0.2, 0.15);
        for (const Vec3& v : mesh.vertices) EXPECT_NEAR(field.value(v), 0, 1e-3);
    }
    EXPECT_EQ(remesh(fine, field, 1u << 20).face_count(), fine.face_count());
}

TEST(PartLabels, FollowTheNearestPrimitiveAndDissolveSpecks) {
    ShapeModel model;
    Sculptor add(model);
    add.part(0).ball(Vec3(-0.4f, 0, 0), 0.5f);
    add.part(1).ball(Vec3(0.4f, 0, 0), 0.5f);
    add.part(0).ball(Vec3(0.88f, 0, 0), 0.04f);  // a speck of part 0 on part 1
    const ImplicitField field(model.primitives);
    const TriangleMesh mesh = remesh(polygonize(field, 0.03f), field, 3000);
    const std::vector<std::int32_t> part = label_faces(mesh, field);
    const std::vector<Vec3> centers = face_centers(mesh);
    for (std::size_t f = 0; f < part.size(); ++f)
        if (std::abs(centers[f].x()) > 0.06f) {
            EXPECT_EQ(part[f], centers[f].x() > 0 ? 1 : 0);
        }
}

}  // namespace
}  // namespace exemplar
