#include "host/hatching/registration/view_registration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "host/core/errors.h"
#include "host/hatching/drawing/drawing_warp.h"
#include "host/hatching/registration/light_fit.h"
#include "host/hatching/registration/pose_fit.h"
#include "host/hatching/tracing/view_outlines.h"
#include "host/imaging/gbuffer.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr int k_paper_width = 320, k_paper_height = 280;

/// Three balls of different sizes and a bar: alike from no two sides.
TriangleMesh snowman_with_arm() {
    TriangleMesh mesh = shapes::icosphere(2, 1);
    mesh = shapes::joined(std::move(mesh), shapes::translated(shapes::icosphere(2, 0.6f), {0.3f, 1.3f, 0}));
    mesh = shapes::joined(std::move(mesh), shapes::translated(shapes::icosphere(2, 0.35f), {0, 2, 0.5f}));
    return shapes::joined(std::move(mesh), shapes::translated(shapes::box(1.6f, 0.3f, 0.3f, 2), {1.3f, 0.4f, 0.5f}));
}

ViewPose known_pose(const PoseFrame& frame) {
    PlacedEye eye;
    eye.eye = {5, 3, 6};
    eye.target = frame.center + Vec3d(0.2, -0.1, 0.1);
    eye.up = Vec3d(0.3, 1, 0).normalized();
    eye.field_of_view = 32;
    return pose_of(eye, frame);
}

/// The outlines of a view, drawn by a pen two pixels thick.
FloatImage outline_drawing(const TriangleMesh& mesh, const ViewPose& pose, const PoseFrame& frame) {
    constexpr int k_finer = 4;
    const PoseFrame fine = frame.resized(k_finer * frame.width, k_finer * frame.height);
    const ViewOutlines outlines =
        view_outlines(render_gbuffer(mesh, pose_camera(pose.scaled(k_finer), fine), fine.width, fine.height));
    FloatImage ink(fine.width, fine.height, 1);
    for (std::size_t i = 0; i < ink.data.size(); ++i) ink.data[i] = outlines.distance(i) <= k_finer ? 1.0f : 0.0f;
    return warp_drawing(ink, Similarity(1.0 / k_finer, 0), frame.width, frame.height);
}

/// The largest distance in pixels between the places of a vertex in two poses.
double largest_move(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& a, const ViewPose& b) {
    double largest = 0;
    for (const Vec3& vertex : mesh.vertices)
        largest = std::max(
            largest, (projected(a, frame, vertex.cast<double>()) - projected(b, frame, vertex.cast<double>())).norm());
    return largest;
}

class KnownView : public testing::Test {
  protected:
    const TriangleMesh mesh_ = snowman_with_arm();
    const PoseFrame frame_ = pose_frame(mesh_, k_paper_width, k_paper_height);
    const ViewPose pose_ = known_pose(frame_);
};

TEST_F(KnownView, PosesAreCameras) {
    const Camera camera = pose_camera(pose_, frame_);
    for (const Vec3& vertex : mesh_.vertices) {
        const Vec2d place = projected(pose_, frame_, vertex.cast<double>());
        const Vec3 pixel = camera.project(vertex, frame_.width, frame_.height);
        EXPECT_NEAR(place.x(), static_cast<double>(pixel.x()), 1e-3);
        EXPECT_NEAR(place.y(), static_cast<double>(pixel.y()), 1e-3);
        const double depth = -(camera.view * vertex.homogeneous()).z();
        EXPECT_LT((unprojected(pose_, frame_, place, depth) - vertex.cast<double>()).norm(), 1e-5);
    }
    EXPECT_LT(largest_move(mesh_, frame_, pose_, pose_of(placed_eye(pose_, frame_), frame_)), 1e-9);
}

TEST_F(KnownView, APoseIsFoundBackFromMatches) {
    PoseChange change;
    change << 0.03, -0.05, 0.04, 0.1, -0.05, 0.03, -0.02;
    ViewPose pose = changed(pose_, frame_, change);
    for (int round = 0; round < 30; ++round) {
        std::vector<LineMatch> matches;
        for (const Vec3& vertex : mesh_.vertices)
            for (const Vec2d& normal : {Vec2d(1, 0), Vec2d(0, 1)}) {
                const Vec3d point = vertex.cast<double>();
                matches.push_back(
                    {point, normal, normal.dot(projected(pose_, frame_, point) - projected(pose, frame_, point))});
            }
        pose = changed(pose, frame_, fitting_change(pose, frame_, matches, 1));
    }
    EXPECT_LT(largest_move(mesh_, frame_, pose_, pose), 0.05);
}

TEST_F(KnownView, ItsDrawingTellsTheCamera) {
    const FloatImage drawing = outline_drawing(mesh_, pose_, frame_);
    std::size_t steps = 0;
    RegistrationOptions options;
    options.step = [&] { ++steps; };
    const std::vector<OutlineFit> fits = register_view(mesh_, drawing, options);
    EXPECT_EQ(steps, k_registration_steps);
    EXPECT_TRUE(fits[0].outlined);
    EXPECT_GT(fits[0].explained, 0.9);
    EXPECT_LT(fits[0].residual, 0.7);
    EXPECT_LT(angle_between(fits[0].pose, pose_), 0.03);
    EXPECT_LT(largest_move(mesh_, frame_, fits[0].pose, pose_), 4);
    for (std::size_t i = 1; i < fits.size(); ++i) EXPECT_LE(fits[0].cost, fits[i].cost);
}

TEST_F(KnownView, AViewNearbySufficesToBegin) {
    const FloatImage drawing = outline_drawing(mesh_, pose_, frame_);
    PoseChange change;
    change << 0.1, -0.12, 0.15, 0.2, -0.2, 0.2, -0.15;
    RegistrationOptions options;
    options.start = changed(pose_, frame_, change);
    ASSERT_GT(largest_move(mesh_, frame_, *options.start, pose_), 20);
    const std::vector<OutlineFit> fits = register_view(mesh_, drawing, options);
    EXPECT_LT(largest_move(mesh_, frame_, fits[0].pose, pose_), 4);
}

TEST_F(KnownView, TheLightIsFoundByAShadedPicture) {
    const Vec3 light = Vec3(-0.4f, 0.5f, 0.7f).normalized();
    const GBuffer gbuffer = render_gbuffer(mesh_, pose_camera(pose_, frame_), frame_.width, frame_.height);
    const std::vector<Vec3> normals = vertex_normals(mesh_);
    FloatImage brightness(frame_.width, frame_.height, 1, 1.0f);
    for (std::size_t i = 0; i < brightness.data.size(); ++i) {
        if (gbuffer.face[i] == k_no_face) continue;
        const Face& face = mesh_.faces[gbuffer.face[i]];
        const auto [b, c] = gbuffer.barycentric[i];
        const Vec3 normal = (1 - b - c) * normals[face[0]] + b * normals[face[1]] + c * normals[face[2]];
        const Vec3 seen = (pose_.axes.cast<float>() * normal).normalized();
        brightness.data[i] = 0.2f + 0.7f * std::max(0.0f, seen.dot(light));
    }
    const LightFit fit = fit_light(brightness, mesh_, pose_, frame_, 0);
    EXPECT_LT(std::acos(std::min(1.0f, fit.direction.dot(light))), 0.03f);
    EXPECT_GT(fit.correlation, 0.98);
}

TEST_F(KnownView, TheFrameOfAnAnimationIsFound) {
    const auto mesh_of = [&](std::size_t frame) {  // the arm sinks
        const float y = 0.4f - 0.5f * static_cast<float>(frame);
        TriangleMesh body =
            shapes::joined(shapes::icosphere(2, 1), shapes::translated(shapes::icosphere(2, 0.6f), {0.3f, 1.3f, 0}));
        return shapes::joined(std::move(body), shapes::translated(shapes::box(2, 0.3f, 0.3f, 2), {1.5f, y, 0.5f}));
    };
    const TriangleMesh drawn = mesh_of(1);
    const PoseFrame frame = pose_frame(drawn, k_paper_width, k_paper_height);
    const ViewPose pose = known_pose(frame);
    const RegisteredFrame found = register_frame(2, mesh_of, outline_drawing(drawn, pose, frame), [] {});
    EXPECT_EQ(found.frame, 1U);
    EXPECT_LT(largest_move(drawn, frame, found.fit.pose, pose), 5);
    EXPECT_THROW(register_frame(0, mesh_of, FloatImage(60, 50, 1), [] {}), UsageError);
}

TEST_F(KnownView, AnEmptyDrawingHasNoView) {
    EXPECT_THROW(register_view(mesh_, FloatImage(60, 50, 1)), DataError);
}

}  // namespace
}  // namespace exemplar
