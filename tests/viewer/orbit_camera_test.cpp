#include "apps/viewer/controls/orbit_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr ViewSize k_size{640, 360};

OrbitCamera fitted(ViewSize size = k_size) {
    OrbitCamera camera;
    camera.fit({.center = Vec3(1, 2, 3), .radius = 2}, size);
    return camera;
}

Vec2 seen_at(const OrbitCamera& camera, const Vec3& point, ViewSize size = k_size) {
    return camera.camera(size).project(point, size.width, size.height).head<2>();
}

// Points all over the ball, of center (1, 2, 3) and radius 2.
std::vector<Vec3> ball_points() {
    std::vector<Vec3> points;
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 40; ++j) {
            const float a = 0.16f * static_cast<float>(i), b = 0.08f * static_cast<float>(j);
            points.push_back(Vec3(1, 2, 3) +
                             2 * Vec3(std::cos(a) * std::sin(b), std::cos(b), std::sin(a) * std::sin(b)));
        }
    return points;
}

TEST(OrbitCamera, FitShowsTheWholeBallInWideAndTallPictures) {
    for (const bool parallel : {false, true})
        for (const ViewSize size : {ViewSize{640, 360}, ViewSize{200, 900}, ViewSize{1, 1}}) {
            OrbitCamera camera = fitted(size);
            camera.set_parallel(parallel);
            for (const Vec3& point : ball_points()) {
                const Vec3 seen = camera.camera(size).project(point, size.width, size.height);
                EXPECT_GT(seen.x(), 0);
                EXPECT_LT(seen.x(), static_cast<float>(size.width));
                EXPECT_GT(seen.y(), 0);
                EXPECT_LT(seen.y(), static_cast<float>(size.height));
                EXPECT_GT(seen.z(), 0);
                EXPECT_LT(seen.z(), 1);
            }
        }
}

TEST(OrbitCamera, FitFillsThePicture) {
    OrbitCamera camera = fitted();
    float highest = 1e9f;
    for (const Vec3& point : ball_points()) highest = std::min(highest, seen_at(camera, point).y());
    EXPECT_LT(highest, 0.08f * 360);
}

TEST(OrbitCamera, OrbitKeepsTargetAndDistance) {
    OrbitCamera camera = fitted();
    camera.orbit({300, 180}, {420, 90}, k_size);
    EXPECT_LT((seen_at(camera, Vec3(1, 2, 3)) - Vec2(320, 180)).norm(), 1e-2f);
    EXPECT_FLOAT_EQ((camera.camera(k_size).position() - camera.target()).norm(), camera.distance());
}

TEST(OrbitCamera, TheFrontOfTheBallFollowsTheCursor) {
    OrbitCamera camera = fitted();
    const Vec3 front = camera.target() + camera.rotation() * Vec3(0, 0, 1);
    camera.orbit({320, 180}, {350, 180}, k_size);
    EXPECT_GT(seen_at(camera, front).x(), 325);
    EXPECT_NEAR(seen_at(camera, front).y(), 180, 0.1);
    OrbitCamera other = fitted();
    other.orbit({320, 180}, {320, 150}, k_size);
    EXPECT_LT(seen_at(other, front).y(), 175);
}

// A turntable flips at its poles, and a ball without a hyperbola jumps at its rim.
TEST(OrbitCamera, SmallStepsOfTheCursorTurnALittleWhereverItIs) {
    Random random(3);
    OrbitCamera camera = fitted();
    Vec2 cursor(320, 180);
    for (int i = 0; i < 5000; ++i) {
        const Vec2 way(static_cast<float>(random.uniform(-1, 1)), static_cast<float>(random.uniform(-1, 1)));
        const Vec2 next = (cursor + way).cwiseMax(Vec2(-50, -50)).cwiseMin(Vec2(690, 410));
        const Eigen::Quaternionf before = camera.rotation();
        camera.orbit(cursor, next, k_size);
        ASSERT_LT(before.angularDistance(camera.rotation()), 0.03f) << "at " << cursor.transpose();
        ASSERT_NEAR(camera.rotation().norm(), 1, 1e-5);
        cursor = next + Vec2(1.5f, 0.7f);
        if (cursor.x() > 690) cursor.x() = -50;
        if (cursor.y() > 410) cursor.y() = -50;
    }
}

TEST(OrbitCamera, GoingBackWithTheCursorGoesBack) {
    OrbitCamera camera = fitted();
    camera.orbit({100, 50}, {500, 300}, k_size);
    camera.orbit({500, 300}, {100, 50}, k_size);
    EXPECT_LT(camera.rotation().angularDistance(Eigen::Quaternionf::Identity()), 1e-3f);
}

TEST(OrbitCamera, PanMovesTheTargetWithTheCursor) {
    for (const bool parallel : {false, true}) {
        OrbitCamera camera = fitted();
        camera.set_parallel(parallel);
        camera.orbit({100, 50}, {300, 200}, k_size);
        const Vec3 point = camera.target();
        camera.pan({320, 180}, {400, 140}, k_size);
        EXPECT_LT((seen_at(camera, point) - Vec2(400, 140)).norm(), 0.05f);
    }
}

TEST(OrbitCamera, ZoomKeepsWhatIsUnderTheCursor) {
    for (const bool parallel : {false, true}) {
        OrbitCamera camera = fitted();
        camera.set_parallel(parallel);
        const Vec3 point = camera.target() + Vec3(0.5f, -0.4f, 0);
        const Vec2 cursor = seen_at(camera, point);
        const float distance = camera.distance();
        camera.zoom(1.7f, cursor, k_size);
        EXPECT_LT((seen_at(camera, point) - cursor).norm(), 0.05f);
        EXPECT_NEAR(camera.distance(), distance / 1.7f, 1e-3f);
    }
}

TEST(OrbitCamera, ZoomHasEndsAndTakesNoNonsense) {
    OrbitCamera camera = fitted();
    for (int i = 0; i < 500; ++i) camera.zoom(2, {10, 20}, k_size);
    EXPECT_TRUE(camera.camera(k_size).view_projection().allFinite());
    EXPECT_GT(camera.distance(), 0);
    for (int i = 0; i < 500; ++i) camera.zoom(0.5f, {10, 20}, k_size);
    EXPECT_TRUE(camera.camera(k_size).view_projection().allFinite());
    const float distance = camera.distance();
    camera.zoom(0, {0, 0}, k_size);
    camera.zoom(std::nanf(""), {0, 0}, k_size);
    EXPECT_EQ(camera.distance(), distance);
}

TEST(OrbitCamera, SidesLookAlongTheirAxes) {
    const auto to_eye = [](ViewSide side) {
        OrbitCamera camera = fitted();
        camera.look_from(side);
        return Vec3(camera.rotation() * Vec3::UnitZ());
    };
    EXPECT_LT((to_eye(ViewSide::front) - Vec3::UnitZ()).norm(), 1e-5f);
    EXPECT_LT((to_eye(ViewSide::back) + Vec3::UnitZ()).norm(), 1e-5f);
    EXPECT_LT((to_eye(ViewSide::right) - Vec3::UnitX()).norm(), 1e-5f);
    EXPECT_LT((to_eye(ViewSide::left) + Vec3::UnitX()).norm(), 1e-5f);
    EXPECT_LT((to_eye(ViewSide::top) - Vec3::UnitY()).norm(), 1e-5f);
    EXPECT_LT((to_eye(ViewSide::bottom) + Vec3::UnitY()).norm(), 1e-5f);
}

TEST(OrbitCamera, UprightPutsYUpWithoutMovingTheEye) {
    OrbitCamera camera = fitted();
    camera.orbit({100, 50}, {420, 330}, k_size);
    const Vec3 eye = camera.camera(k_size).position();
    camera.turn_upright();
    EXPECT_LT((camera.camera(k_size).position() - eye).norm(), 1e-4f);
    EXPECT_NEAR((camera.rotation() * Vec3::UnitX()).y(), 0, 1e-5f);
    EXPECT_GT((camera.rotation() * Vec3::UnitY()).y(), 0);
    camera.look_from(ViewSide::top);
    camera.turn_upright();
    EXPECT_TRUE(camera.rotation().coeffs().allFinite());
}

TEST(OrbitCamera, ABallAroundPointsHoldsThem) {
    const std::vector<Vec3> points = ball_points();
    const ViewBall ball = ball_around(points);
    for (const Vec3& point : points) EXPECT_LE((point - ball.center).norm(), ball.radius * 1.0001f);
    EXPECT_LT(ball.radius, 2.2f);
    EXPECT_GT(ball_around(std::vector<Vec3>{Vec3(5, 5, 5)}).radius, 0);
    EXPECT_GT(ball_around({}).radius, 0);
}

}  // namespace
}  // namespace exemplar
