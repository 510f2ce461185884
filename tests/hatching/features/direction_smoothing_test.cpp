#include "host/hatching/features/direction_smoothing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

float angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

struct Field {
    std::vector<Vec3> directions;
    std::vector<float> confidence;
    explicit Field(std::size_t count) : directions(count, Vec3::Zero()), confidence(count) {}
    void set(std::size_t v, const Vec3& direction, float trust) {
        directions[v] = direction;
        confidence[v] = trust;
    }
};

std::vector<Vec3> radial(const TriangleMesh& mesh) {
    std::vector<Vec3> normals;
    for (const Vec3& v : mesh.vertices) normals.push_back(Vec3(v.x(), v.y(), 0).normalized());
    return normals;
}

/// The unit direction on a cylinder along z that makes this angle with it.
Vec3 helix(const Vec3& normal, float angle) {
    return std::cos(angle) * Vec3::UnitZ() + std::sin(angle) * Vec3::UnitZ().cross(normal);
}

// A cylinder can be rolled out: what changes least keeps its angle with the axis. What little pulls to zero where
// nothing is known is 1e-7 of a vertex's neighbors, which a hundred rings away makes 1e-3.
TEST(DirectionSmoothing, CarriesADirectionAroundACylinder) {
    const TriangleMesh mesh = shapes::cylinder(1, 4, 40, 30, false);
    const std::vector<Vec3> normals = radial(mesh);
    const DirectionSmoother smoother(mesh, normals);
    for (const float angle : {0.0f, 0.4f, 1.2f, 1.57f, 2.5f}) {
        Field field(mesh.vertex_count());
        // Of either sign, and of any length.
        for (const std::size_t v : {3u, 500u, 900u})
            field.set(v, (v == 500 ? -3.0f : 0.1f) * helix(normals[v], angle), 1);
        const std::vector<Vec3> completed = smoother.complete(field.directions, field.confidence);
        for (std::size_t v = 0; v < completed.size(); ++v) {
            ASSERT_NEAR(completed[v].norm(), 1, 1e-5f) << v;
            ASSERT_NEAR(completed[v].dot(normals[v]), 0, 1e-5f) << v;
            ASSERT_LT(angle_between(completed[v], helix(normals[v], angle)), 1e-3f) << v;
        }
    }
}

// Between two rings that differ, angles change evenly: the rolled-out field is harmonic.
TEST(DirectionSmoothing, TurnsEvenlyBetweenWhatIsGiven) {
    constexpr std::size_t k_around = 40, k_rings = 31;
    const TriangleMesh mesh = shapes::cylinder(1, 4, k_around, k_rings - 1, false);
    const std::vector<Vec3> normals = radial(mesh);
    Field field(mesh.vertex_count());
    constexpr float k_low = 0.3f, k_high = 0.5f;
    for (std::size_t i = 0; i < k_around; ++i) {
        field.set(i, helix(normals[i], k_low), 1);
        const std::size_t last = (k_rings - 1) * k_around + i;
        field.set(last, helix(normals[last], k_high), 1);
    }
    const std::vector<Vec3> completed = DirectionSmoother(mesh, normals).complete(field.directions, field.confidence);
    for (std::size_t v = 0; v < completed.size(); ++v) {
        // The sum of two vectors of doubled angle, as far apart as 0.4, in between: to second order linear in the
        // angle.
        const std::size_t ring = v / k_around;
        const float t = static_cast<float>(ring) / (k_rings - 1);
        const float x = (1 - t) * std::cos(2 * k_low) + t * std::cos(2 * k_high),
                    y = (1 - t) * std::sin(2 * k_low) + t * std::sin(2 * k_high);
        EXPECT_LT(angle_between(completed[v], helix(normals[v], 0.5f * std::atan2(y, x))), 2e-3f) << v;
    }
}

// What is sure stays; what counts half is halfway between itself and its neighbors (vectors of doubled angle 0 and 90
// degrees: 22.5 degrees).
TEST(DirectionSmoothing, ConfidenceSaysHowMuchADirectionCounts) {
    const TriangleMesh mesh = shapes::grid(20, 20, 1);
    const std::vector<Vec3> normals(mesh.vertex_count(), Vec3::UnitZ());
    const std::size_t middle = 10 * 21 + 10;
    const DirectionSmoother smoother(mesh, normals);
    for (const auto& [confidence, expected] : {std::pair(1.0f, 0.7854f), {0.5f, 0.3927f}, {0.0f, 0.0f}}) {
        Field field(mesh.vertex_count());
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v) field.set(v, Vec3::UnitX(), 1);
        field.set(middle, {1, 1, 0}, confidence);
        const std::vector<Vec3> completed = smoother.complete(field.directions, field.confidence);
        EXPECT_NEAR(angle_between(completed[middle], Vec3::UnitX()), expected, 1e-3f);
        EXPECT_LT(angle_between(completed[middle + 1], Vec3::UnitX()), 1e-3f);
    }
}

// Frames at vertices are arbitrary; nothing of them is left in the result. Where a field has a singularity its length
// goes to zero, and with it what its direction is known to: some vertices are left out.
TEST(DirectionSmoothing, TurnsWithTheSurface) {
    const TriangleMesh mesh = shapes::torus(2, 0.7f, 24, 14);
    Random random(3);
    Field field(mesh.vertex_count());
    for (std::size_t v = 0; v < mesh.vertex_count(); v += 5)
        field.set(v, shapes::detail::vec3(random.normal(), random.normal(), random.normal()),
                  static_cast<float>(random.uniform()));
    const std::vector<Vec3> before =
        DirectionSmoother(mesh, vertex_normals(mesh)).complete(field.directions, field.confidence);
    const Eigen::Matrix3f rotation = shapes::random_rotation(8);
    const TriangleMesh turned = shapes::rotated(mesh, rotation);
    for (Vec3& direction : field.directions) direction = rotation * direction;
    const std::vector<Vec3> after =
        DirectionSmoother(turned, vertex_normals(turned)).complete(field.directions, field.confidence);
    std::size_t apart = 0;
    for (std::size_t v = 0; v < before.size(); ++v) apart += angle_between(rotation * before[v], after[v]) > 1e-3f;
    EXPECT_LE(apart, 2U);
}

TEST(DirectionSmoothing, LeavesWhatNothingReachesWithoutDirection) {
    const TriangleMesh one = shapes::cylinder(1, 3, 12, 8, false);
    const TriangleMesh mesh = shapes::joined(one, shapes::translated(one, {5, 0, 0}));
    const std::vector<Vec3> normals = vertex_normals(mesh);
    Field field(mesh.vertex_count());
    field.set(7, Vec3::UnitX(), 1);
    field.set(one.vertex_count() + 3, Vec3::UnitX(), 0);  // does not count
    field.set(one.vertex_count() + 9, Vec3::Zero(), 1);   // is none
    const std::vector<Vec3> completed = DirectionSmoother(mesh, normals).complete(field.directions, field.confidence);
    for (std::size_t v = 0; v < completed.size(); ++v) {
        if (v < one.vertex_count()) {
            EXPECT_NEAR(completed[v].norm(), 1, 1e-5f) << v;
        } else {
            EXPECT_EQ(completed[v], Vec3::Zero().eval()) << v;
        }
    }
}

TEST(DirectionSmoothing, RefusesFieldsOfAnotherSize) {
    const TriangleMesh mesh = shapes::icosphere(1, 1);
    const DirectionSmoother smoother(mesh, vertex_normals(mesh));
    const Field right(mesh.vertex_count()), wrong(mesh.vertex_count() + 1);
    EXPECT_THROW(smoother.complete(wrong.directions, right.confidence), UsageError);
    EXPECT_THROW(smoother.complete(right.directions, wrong.confidence), UsageError);
}

}  // namespace
}  // namespace exemplar
