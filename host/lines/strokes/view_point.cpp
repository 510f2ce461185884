#include "host/lines/strokes/view_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "host/core/errors.h"

namespace exemplar {
namespace {

struct NamedView {
    const char* name;
    Vec3 direction;  ///< to the eye, where y is up and z comes to the front
};
const std::array<NamedView, 9>& named_views() {
    static const std::array<NamedView, 9> views = {NamedView{"front", {0, 0, 1}},
                                                   {"back", {0, 0, -1}},
                                                   {"right", {1, 0, 0}},
                                                   {"side", {1, 0, 0}},
                                                   {"left", {-1, 0, 0}},
                                                   {"top", {0, 1, 0}},
                                                   {"bottom", {0, -1, 0}},
                                                   {"three-quarter", {0.6f, 0.35f, 1}},
                                                   {"three-quarter-back", {-0.6f, 0.35f, -1}}};
    return views;
}

struct Range {
    float low = std::numeric_limits<float>::max(), high = -low;
};
/// Depths of points along the camera's axis.
Range depths(const Camera& camera, const std::vector<Vec3>& points) {
    Range range;
    for (const Vec3& p : points) {
        const float depth = -(camera.view.block<1, 3>(2, 0) * p)(0) - camera.view(2, 3);
        range.low = std::min(range.low, depth);
        range.high = std::max(range.high, depth);
    }
    return range;
}

Vec3 center_of(const std::vector<Vec3>& points) {
    Vec3 low = points[0], high = points[0];
    for (const Vec3& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return 0.5f * (low + high);
}

float radians(double degrees) {
    return static_cast<float>(degrees * std::numbers::pi / 180);
}

Camera placed_camera(const ViewPoint& point, const std::vector<Vec3>& points, float aspect) {
    const Vec3 eye = *point.eye, target = point.target ? *point.target : center_of(points);
    if (eye == target) throw UsageError("the eye and its target are the same point; move one of them");
    Camera camera;
    camera.view = look_at(eye, target, point.up);
    const Range range = depths(camera, points);
    const float size = std::max(range.high - range.low, 1e-3f * (eye - target).norm());
    const float far = std::max(range.high, 0.0f) + size;
    if (point.field_of_view > 0)
        camera.projection =
            perspective(radians(point.field_of_view), aspect, std::max(0.5f * range.low, 1e-3f * size), far);
    else
        camera.projection = orthographic((eye - target).norm() * 0.2035f, aspect, range.low - size, far);
    return camera;
}

Camera fitted_camera(const ViewPoint& point, const TriangleMesh& extent, float aspect) {
    // Named views are rotated along with `up`.
    const Vec3 direction = Eigen::Quaternionf::FromTwoVectors(Vec3::UnitY(), point.up) *
                           view_direction(point.view).value_or(Vec3::UnitZ());
    FitOptions options;
    options.vertical_fov = radians(point.field_of_view);
    options.up = point.up;
    Camera camera = fit_camera(extent, direction, aspect, options);
    // Other frames than those of `extent` may reach farther.
    const Range range = depths(camera, extent.vertices);
    const float size = std::max(range.high - range.low, 1e-3f * range.high);
    const float near = std::max(range.low - 0.5f * size, 0.05f * range.low), far = range.high + 0.5f * size;
    const bool parallel = camera.projection(3, 3) != 0;
    camera.projection(2, 2) = (parallel ? 1 : far) / (near - far);
    camera.projection(2, 3) = (parallel ? near : near * far) / (near - far);
    return camera;
}

}  // namespace

std::vector<std::string> view_names() {
    std::vector<std::string> names;
    for (const NamedView& view : named_views()) names.emplace_back(view.name);
    return names;
}

std::optional<Vec3> view_direction(std::string_view name) {
    for (const NamedView& view : named_views())
        if (name == view.name) return view.direction;
    return std::nullopt;
}

Camera camera_at(const ViewPoint& point, const TriangleMesh& extent) {
    const float aspect = static_cast<float>(point.width) / static_cast<float>(point.height);
    Camera camera = point.eye ? placed_camera(point, extent.vertices, aspect) : fitted_camera(point, extent, aspect);
    Eigen::Matrix4f moved = Eigen::Matrix4f::Identity();
    moved(0, 3) = 2 * point.shift.x() / aspect;
    moved(1, 3) = -2 * point.shift.y();
    camera.projection = moved * camera.projection;
    return camera;
}

StrokeView stroke_view(const ViewPoint& point, const TriangleMesh& extent, float feature_size) {
    StrokeView view;
    view.width = point.width;
    view.height = point.height;
    view.camera = camera_at(point, extent);
    const Range center = depths(view.camera, {center_of(extent.vertices)});
    const Range all = depths(view.camera, extent.vertices);
    view.unit_depth = std::max({center.low, 1e-3f * (all.high - all.low), 1e-30f});
    view.feature_size = feature_size;
    return view;
}

}  // namespace exemplar
