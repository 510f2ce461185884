#pragma once

#include <Eigen/Core>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A viewpoint as two matrices for column vectors. View space is right-handed: x right, y up, the camera looks along
/// -z. Clip space is Vulkan's: after division by w, x and y run from -1 to 1 with y DOWN, and z runs from 0 on the near
/// plane to 1 on the far plane. So no viewport flip is needed, and a triangle that is counter-clockwise seen from
/// outside stays counter-clockwise on the screen (VK_FRONT_FACE_COUNTER_CLOCKWISE).
struct Camera {
    Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
    Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();

    Eigen::Matrix4f view_projection() const { return projection * view; }
    /// Returns the eye in world space.
    Vec3 position() const;
    /// Returns the unit vector from `point` to the eye; for a parallel projection it is the same everywhere.
    Vec3 to_eye(const Vec3& point) const;
    /// Returns the pixel coordinates (x right, y down, (0, 0) the image's upper left corner) and depth in [0, 1] of
    /// a world point.
    Vec3 project(const Vec3& point, int width, int height) const;
};

/// Returns the view matrix of an eye that looks at `target`. `up` points up in the image; another axis replaces it
/// if it is (nearly) the viewing direction. Throws UsageError if eye and target coincide.
Eigen::Matrix4f look_at(const Vec3& eye, const Vec3& target, const Vec3& up = Vec3::UnitY());

/// Returns a perspective projection: full vertical field of view in radians, aspect = width / height, 0 < near <
/// far.
Eigen::Matrix4f perspective(float vertical_fov, float aspect, float near, float far);

/// Returns the parallel projection of the box |y| <= half_height, |x| <= half_height * aspect, near <= -z <= far.
Eigen::Matrix4f orthographic(float half_height, float aspect, float near, float far);

struct FitOptions {
    float vertical_fov = 0.4f;  ///< radians, full angle; 0 gives a parallel projection
    float margin = 0.05f;       ///< free share of the image's half width or half height
    Vec3 up = Vec3::UnitY();
};
/// Returns a camera in direction `direction` from the mesh (any length but zero) that shows the whole mesh as large
/// as it fits into an image of aspect = width / height. Throws MeshError for a mesh without vertices.
Camera fit_camera(const TriangleMesh& mesh, const Vec3& direction, float aspect, const FitOptions& options = {});

}  // namespace exemplar
