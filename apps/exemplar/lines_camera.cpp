#include "apps/exemplar/lines_camera.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "apps/help/offered_words.h"
#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/loose_vertices.h"

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

std::vector<std::string> view_names() {
    std::vector<std::string> names;
    for (const NamedView& view : named_views()) names.emplace_back(view.name);
    return names;
}

Vec3 direction_named(const std::string& name) {
    for (const NamedView& view : named_views())
        if (name == view.name) return view.direction;
    const std::vector<std::string> names = view_names();
    throw UsageError(fmt::format("--view '{}' is no view{}; the views are {}, or give --eye X,Y,Z", name,
                                 suggestion(name, names), fmt::join(names, ", ")));
}

std::array<int, 2> size_of(const std::string& text) {
    constexpr int k_most = 16384;
    std::array<int, 2> size{};
    const std::size_t cross = text.find('x');
    const auto read = [&](std::size_t begin, std::size_t end, int& value) {
        const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
        return error == std::errc() && stop == text.data() + end && value >= 1 && value <= k_most;
    };
    if (cross == std::string::npos || !read(0, cross, size[0]) || !read(cross + 1, text.size(), size[1]))
        throw UsageError(fmt::format("--size '{}' is no size; write WIDTHxHEIGHT as 1000x800, up to {}", text, k_most));
    return size;
}

/// Vertices of evenly taken frames together: what a camera has to show.
TriangleMesh extent_of(const LinesSource& source) {
    constexpr std::size_t k_most_frames = 60;
    TriangleMesh all;
    const std::vector<std::uint32_t> used = vertices_of_faces(source.animation().rest);
    const std::size_t count = std::min(source.frame_count(), k_most_frames);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t frame = count > 1 ? i * (source.frame_count() - 1) / (count - 1) : 0;
        const std::vector<Vec3> vertices = source.vertices(frame);
        for (const std::uint32_t v : used) all.vertices.push_back(vertices[v]);
    }
    return all;
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

/// A camera at --eye. Parallel, it shows as much at the target as one of 23 degrees would.
Camera placed_camera(const CameraArguments& arguments, const std::vector<Vec3>& points, float aspect) {
    const Vec3 eye = point_of(arguments.eye, "--eye");
    const Vec3 target = arguments.target.empty() ? center_of(points) : point_of(arguments.target, "--target");
    if (eye == target) throw UsageError("--eye and --target are the same point; move one of them");
    Camera camera;
    camera.view = look_at(eye, target, point_of(arguments.up, "--up"));
    const Range range = depths(camera, points);
    const float size = std::max(range.high - range.low, 1e-3f * (eye - target).norm());
    const float far = std::max(range.high, 0.0f) + size;
    const auto angle = static_cast<float>(arguments.field_of_view * std::numbers::pi / 180);
    if (arguments.field_of_view > 0)
        camera.projection = perspective(angle, aspect, std::max(0.5f * range.low, 1e-3f * size), far);
    else
        camera.projection = orthographic((eye - target).norm() * 0.2035f, aspect, range.low - size, far);
    return camera;
}

Camera fitted_camera(const CameraArguments& arguments, const TriangleMesh& extent, float aspect) {
    const Vec3 up = point_of(arguments.up, "--up");
    // "front" is turned along with what is up.
    const Vec3 direction = Eigen::Quaternionf::FromTwoVectors(Vec3::UnitY(), up) * direction_named(arguments.view);
    FitOptions options;
    options.vertical_fov = static_cast<float>(arguments.field_of_view * std::numbers::pi / 180);
    options.up = up;
    Camera camera = fit_camera(extent, direction, aspect, options);
    // Frames that were not looked at may reach farther.
    const Range range = depths(camera, extent.vertices);
    const float size = std::max(range.high - range.low, 1e-3f * range.high);
    const float near = std::max(range.low - 0.5f * size, 0.05f * range.low), far = range.high + 0.5f * size;
    const bool parallel = camera.projection(3, 3) != 0;
    camera.projection(2, 2) = (parallel ? 1 : far) / (near - far);
    camera.projection(2, 3) = (parallel ? near : near * far) / (near - far);
    return camera;
}

}  // namespace

Vec3 point_of(const std::string& text, const char* option) {
    Vec3 point;
    const char *at = text.data(), *end = text.data() + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [stop, error] = std::from_chars(at, end, point[i]);
        const bool last = i == 2;
        if (error != std::errc() || !std::isfinite(point[i]) || (last ? stop != end : stop == end || *stop != ','))
            throw UsageError(fmt::format("{} '{}' is no point; write three numbers as 1.5,0,-2", option, text));
        at = stop + 1;
    }
    return point;
}

void add_camera_options(CLI::App& command, CameraArguments& arguments) {
    command
        .add_option("--view", arguments.view,
                    fmt::format("where it is seen from, as large as it fits: {}", fmt::join(view_names(), ", ")))
        ->type_name("NAME")
        ->check(offered_words(view_names()))
        ->capture_default_str();
    command.add_option("--eye", arguments.eye, "a point to see it from instead, in the units of the mesh")
        ->type_name("X,Y,Z");
    command.add_option("--target", arguments.target, "the point that --eye looks at; default: the middle")
        ->type_name("X,Y,Z");
    command.add_option("--up", arguments.up, "what is up in the picture; 0,0,1 for meshes that stand along z")
        ->type_name("X,Y,Z")
        ->capture_default_str();
    command.add_option("--fov", arguments.field_of_view, "vertical angle of view in degrees; 0: parallel projection")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 170.0));
    command.add_option("--size", arguments.size, "pixels of the drawing")->type_name("WxH")->capture_default_str();
}

void require_camera(const CameraArguments& arguments) {
    size_of(arguments.size);
    direction_named(arguments.view);
    if (!(point_of(arguments.up, "--up").norm() > 0)) throw UsageError("--up is zero; give a direction as 0,1,0");
    if (!arguments.eye.empty()) point_of(arguments.eye, "--eye");
    if (arguments.target.empty()) return;
    if (arguments.eye.empty()) throw UsageError("--target is where --eye looks; give --eye, too");
    point_of(arguments.target, "--target");
}

SizedCamera camera_of(const CameraArguments& arguments, const TriangleMesh& extent) {
    const auto [width, height] = size_of(arguments.size);
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    return {arguments.eye.empty() ? fitted_camera(arguments, extent, aspect)
                                  : placed_camera(arguments, extent.vertices, aspect),
            width, height};
}

StrokeView view_of(const CameraArguments& arguments, LinesSource& source) {
    const TriangleMesh extent = extent_of(source);
    const SizedCamera camera = camera_of(arguments, extent);
    StrokeView view;
    view.width = camera.width;
    view.height = camera.height;
    view.camera = camera.camera;
    const Range center = depths(view.camera, {center_of(extent.vertices)});
    const Range all = depths(view.camera, extent.vertices);
    view.unit_depth = std::max({center.low, 1e-3f * (all.high - all.low), 1e-30f});
    view.feature_size = source.feature_size();
    return view;
}

}  // namespace exemplar
