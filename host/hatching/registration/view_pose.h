#pragma once

#include <Eigen/Core>

#include "host/imaging/camera.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

namespace exemplar {

using Vec2d = Eigen::Vector2d;
/// A small change of a pose: a rotation about the camera's axes (radians), the logarithms of distance and scale, and a
/// move in the picture, in radii of the object.
using PoseChange = Eigen::Matrix<double, 7, 1>;

/// The frame of reference of a pose: the sphere around an object, and a picture, whose middle is on the camera's axis.
struct PoseFrame {
    Vec3d center = Vec3d::Zero();
    double radius = 1;          ///< mesh units
    int width = 0, height = 0;  ///< pixels

    /// Returns the same for a picture of another size, which shows the same.
    PoseFrame resized(int new_width, int new_height) const { return {center, radius, new_width, new_height}; }
};
PoseFrame pose_frame(const TriangleMesh& mesh, int width, int height);

/// How a camera sees an object: seven numbers.
struct ViewPose {
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows: to the right, up and towards the eye, mesh frame
    double distance = 1;                                 ///< of the object's center along the axis, mesh units
    double scale = 1;                                    ///< pixels per mesh unit at that distance
    Vec2d place = Vec2d::Zero();                         ///< of the object's center, pixels

    /// Returns the focal length in pixels.
    double focal_length() const { return scale * distance; }
    /// Returns the pose in a picture `factor` times as large.
    ViewPose scaled(double factor) const { return {axes, distance, factor * scale, factor * place}; }
};

/// Returns the angle that the axes of one pose are turned by against the other's, radians.
double angle_between(const ViewPose& first, const ViewPose& second);
ViewPose changed(const ViewPose& pose, const PoseFrame& frame, const PoseChange& change);
/// Returns the pixel coordinates of a point of the mesh.
Vec2d projected(const ViewPose& pose, const PoseFrame& frame, const Vec3d& point);
/// Returns the point of space at a pixel and a depth along the camera's axis (GBuffer::depth).
Vec3d unprojected(const ViewPose& pose, const PoseFrame& frame, const Vec2d& place, double depth);
Camera pose_camera(const ViewPose& pose, const PoseFrame& frame);

/// A camera as the options of the programs give it.
struct PlacedEye {
    Vec3d eye, target, up;     ///< mesh units; `up` is a unit vector
    double field_of_view = 0;  ///< degrees, vertical
};
PlacedEye placed_eye(const ViewPose& pose, const PoseFrame& frame);
/// Returns the pose of such a camera.
ViewPose pose_of(const PlacedEye& eye, const PoseFrame& frame);

}  // namespace exemplar
