#include "host/imaging/camera.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "host/core/errors.h"

namespace exemplar {
namespace {

bool is_parallel(const Eigen::Matrix4f& projection) {
    return projection(3, 3) != 0;
}

/// Returns the rotation whose rows are right, up and backward for a camera that looks along -backward.
Eigen::Matrix3f camera_axes(const Vec3& backward, const Vec3& up) {
    Vec3 right = up.normalized().cross(backward);
    if (right.norm() < 1e-3f) right = (std::abs(backward.z()) < 0.9f ? Vec3::UnitZ() : Vec3::UnitX()).cross(backward);
    right.normalize();
    Eigen::Matrix3f axes;
    axes.row(0) = right;
    axes.row(1) = backward.cross(right);
    axes.row(2) = backward;
    return axes;
}

}  // namespace

Vec3 Camera::position() const {
    return -view.topLeftCorner<3, 3>().transpose() * view.topRightCorner<3, 1>();
}

Vec3 Camera::to_eye(const Vec3& point) const {
    if (is_parallel(projection)) return view.block<1, 3>(2, 0).transpose();
    return (position() - point).normalized();
}

Vec3 Camera::project(const Vec3& point, int width, int height) const {
    const Eigen::Vector4f clip = view_projection() * point.homogeneous();
    const Vec3 ndc = clip.head<3>() / clip.w();
    return {(ndc.x() + 1) * 0.5f * static_cast<float>(width), (ndc.y() + 1) * 0.5f * static_cast<float>(height),
            ndc.z()};
}

Eigen::Matrix4f look_at(const Vec3& eye, const Vec3& target, const Vec3& up) {
    if (eye == target) throw UsageError("look_at: eye and target coincide; move one of them");
    const Eigen::Matrix3f axes = camera_axes((eye - target).normalized(), up);
    Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
    view.topLeftCorner<3, 3>() = axes;
    view.topRightCorner<3, 1>() = -axes * eye;
    return view;
}

Eigen::Matrix4f perspective(float vertical_fov, float aspect, float near, float far) {
    const float focal = 1 / std::tan(vertical_fov / 2);
    Eigen::Matrix4f m = Eigen::Matrix4f::Zero();
    m(0, 0) = focal / aspect;
    m(1, 1) = -focal;  // y down
    m(2, 2) = far / (near - far);
    m(2, 3) = near * far / (near - far);
    m(3, 2) = -1;
    return m;
}

Eigen::Matrix4f orthographic(float half_height, float aspect, float near, float far) {
    Eigen::Matrix4f m = Eigen::Matrix4f::Identity();
    m(0, 0) = 1 / (half_height * aspect);
    m(1, 1) = -1 / half_height;  // y down
    m(2, 2) = 1 / (near - far);
    m(2, 3) = near / (near - far);
    return m;
}

Camera fit_camera(const TriangleMesh& mesh, const Vec3& direction, float aspect, const FitOptions& options) {
    if (mesh.vertices.empty()) throw MeshError("fit_camera: the mesh has no vertices; nothing can be shown");
    if (direction.norm() == 0) throw UsageError("fit_camera: the viewing direction is zero; give a direction");
    const Eigen::Matrix3f axes = camera_axes(direction.normalized(), options.up);
    Vec3 low = axes * mesh.vertices[0], high = low;
    for (const Vec3& vertex : mesh.vertices) {
        const Vec3 p = axes * vertex;
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Vec3 center = (low + high) / 2;
    // A mesh of one point gets some depth, enough that eye and target differ wherever it lies.
    float depth = (high - low).norm();
    if (!(depth > 1e-5f * center.norm())) depth = center.norm() > 0 ? 1e-5f * center.norm() : 1;
    const float room = 1 - options.margin;

    // The maximum ratio of a vertex' offset to the room in the image decides the half height, or the distance in
    // perspective.
    const bool parallel = options.vertical_fov <= 0;
    const float slope = std::tan(options.vertical_fov / 2);
    float half_height = 1e-6f * depth, distance = 0;
    for (const Vec3& vertex : mesh.vertices) {
        const Vec3 p = axes * vertex - center;
        const float extent = std::max(std::abs(p.y()), std::abs(p.x()) / aspect) / room;
        half_height = std::max(half_height, extent);
        if (!parallel) distance = std::max(distance, p.z() + extent / slope);
    }
    const float half_depth = (high.z() - low.z()) / 2;
    distance = std::max(distance, half_depth + 0.05f * depth);

    Camera camera;
    const Vec3 target = axes.transpose() * center;
    camera.view = look_at(target + axes.transpose() * Vec3(0, 0, distance), target, options.up);
    const float near = std::max(distance - half_depth - 0.02f * depth, 0.01f * depth);
    const float far = distance + half_depth + 0.02f * depth;
    camera.projection =
        parallel ? orthographic(half_height, aspect, near, far) : perspective(options.vertical_fov, aspect, near, far);
    return camera;
}

}  // namespace exemplar
