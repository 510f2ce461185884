#include "host/hatching/registration/view_pose.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace exemplar {
namespace {

/// The object's center in camera coordinates: to the right, up, towards the eye.
Vec3d center_seen(const ViewPose& pose, const PoseFrame& frame) {
    return {(pose.place.x() - 0.5 * frame.width) / pose.scale, (0.5 * frame.height - pose.place.y()) / pose.scale,
            -pose.distance};
}

}  // namespace

PoseFrame pose_frame(const TriangleMesh& mesh, int width, int height) {
    const BoundingBox box = bounding_box(mesh);
    return {(box.low + box.high) / 2, box.diagonal() / 2, width, height};
}

double angle_between(const ViewPose& first, const ViewPose& second) {
    return Eigen::AngleAxisd(first.axes * second.axes.transpose()).angle();
}

ViewPose changed(const ViewPose& pose, const PoseFrame& frame, const PoseChange& change) {
    const Vec3d turn = change.head<3>();
    const double angle = turn.norm();
    ViewPose next = pose;
    if (angle > 0) next.axes = Eigen::AngleAxisd(angle, turn / angle) * pose.axes;
    next.distance *= std::exp(change[3]);
    next.scale *= std::exp(change[4]);
    next.place += change.tail<2>() * (pose.scale * frame.radius);
    return next;
}

Vec2d projected(const ViewPose& pose, const PoseFrame& frame, const Vec3d& point) {
    const Vec3d seen = pose.axes * (point - frame.center) + center_seen(pose, frame);
    const double zoom = pose.focal_length() / -seen.z();
    return {0.5 * frame.width + zoom * seen.x(), 0.5 * frame.height - zoom * seen.y()};
}

Vec3d unprojected(const ViewPose& pose, const PoseFrame& frame, const Vec2d& place, double depth) {
    const double zoom = depth / pose.focal_length();
    const Vec3d seen(zoom * (place.x() - 0.5 * frame.width), zoom * (0.5 * frame.height - place.y()), -depth);
    return frame.center + pose.axes.transpose() * (seen - center_seen(pose, frame));
}

Camera pose_camera(const ViewPose& pose, const PoseFrame& frame) {
    const Vec3d eye = placed_eye(pose, frame).eye;
    Camera camera;
    camera.view.topLeftCorner<3, 3>() = pose.axes.cast<float>();
    camera.view.topRightCorner<3, 1>() = (-pose.axes * eye).cast<float>();
    const double margin = 1.05 * frame.radius;
    const double near = std::max(pose.distance - margin, 0.01 * pose.distance);
    camera.projection = perspective(static_cast<float>(2 * std::atan(0.5 * frame.height / pose.focal_length())),
                                    static_cast<float>(frame.width) / static_cast<float>(frame.height),
                                    static_cast<float>(near), static_cast<float>(pose.distance + margin));
    return camera;
}

PlacedEye placed_eye(const ViewPose& pose, const PoseFrame& frame) {
    const Vec3d eye = frame.center - pose.axes.transpose() * center_seen(pose, frame);
    const Vec3d backward = pose.axes.row(2);
    return {eye, eye - pose.distance * backward, pose.axes.row(1),
            2 * std::atan(0.5 * frame.height / pose.focal_length()) * 180 / std::numbers::pi};
}

ViewPose pose_of(const PlacedEye& eye, const PoseFrame& frame) {
    ViewPose pose;
    const Vec3d backward = (eye.eye - eye.target).normalized();
    const Vec3d right = eye.up.cross(backward).normalized();
    pose.axes.row(0) = right;
    pose.axes.row(1) = backward.cross(right);
    pose.axes.row(2) = backward;
    const Vec3d seen = pose.axes * (frame.center - eye.eye);
    pose.distance = -seen.z();
    const double focal = 0.5 * frame.height / std::tan(eye.field_of_view * std::numbers::pi / 360);
    pose.scale = focal / pose.distance;
    pose.place = {0.5 * frame.width + pose.scale * seen.x(), 0.5 * frame.height - pose.scale * seen.y()};
    return pose;
}

}  // namespace exemplar
