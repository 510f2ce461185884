#include "apps/exemplar/lines/lines_camera.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/lines/strokes/view_point.h"
#include "host/mesh/editing/loose_vertices.h"

namespace exemplar {
namespace {

void require_view(const std::string& name) {
    if (view_direction(name)) return;
    const std::vector<std::string> names = view_names();
    throw UsageError(fmt::format("--view '{}' is no view{}; the views are {}, or give --eye X,Y,Z", name,
                                 suggestion(name, names), fmt::join(names, ", ")));
}

std::array<int, 2> size_of(const std::string& text) {
    std::array<int, 2> size{};
    const std::size_t cross = text.find('x');
    const auto read = [&](std::size_t begin, std::size_t end, int& value) {
        const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
        return error == std::errc() && stop == text.data() + end && value >= 1 && value <= k_max_picture_size;
    };
    if (cross == std::string::npos || !read(0, cross, size[0]) || !read(cross + 1, text.size(), size[1]))
        throw UsageError(
            fmt::format("--size '{}' is no size; write WIDTHxHEIGHT as 1000x800, up to {}", text, k_max_picture_size));
    return size;
}

/// Parses numbers separated by commas; returns false if the text is anything else.
bool parse_numbers(const std::string& text, std::span<float> numbers) {
    const char *at = text.data(), *end = text.data() + text.size();
    for (float& number : numbers) {
        const auto [stop, error] = std::from_chars(at, end, number);
        const bool last = &number == &numbers.back();
        if (error != std::errc() || !std::isfinite(number) || (last ? stop != end : stop == end || *stop != ','))
            return false;
        at = stop + 1;
    }
    return true;
}

Vec2 shift_of(const std::string& text) {
    std::array<float, 2> shift{};
    if (!parse_numbers(text, shift))
        throw UsageError(fmt::format("--shift '{}' is no shift; write two numbers as 0.1,-0.2", text));
    return {shift[0], shift[1]};
}

/// Returns the vertices of evenly spaced frames together, which a camera has to show.
TriangleMesh extent_of(const LinesSource& source) {
    constexpr std::size_t k_max_frames = 60;
    TriangleMesh all;
    const std::vector<std::uint32_t> used = vertices_of_faces(source.animation().rest);
    const std::size_t count = std::min(source.frame_count(), k_max_frames);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t frame = count > 1 ? i * (source.frame_count() - 1) / (count - 1) : 0;
        const std::vector<Vec3> vertices = source.vertices(frame);
        for (const std::uint32_t v : used) all.vertices.push_back(vertices[v]);
    }
    return all;
}

ViewPoint view_point(const CameraArguments& arguments) {
    ViewPoint point;
    point.view = arguments.view;
    if (!arguments.eye.empty()) point.eye = point_of(arguments.eye, "--eye");
    if (!arguments.target.empty()) point.target = point_of(arguments.target, "--target");
    point.up = point_of(arguments.up, "--up");
    point.field_of_view = arguments.field_of_view;
    point.shift = shift_of(arguments.shift);
    const auto [width, height] = size_of(arguments.size);
    point.width = width;
    point.height = height;
    return point;
}

}  // namespace

Vec3 point_of(const std::string& text, const char* option) {
    std::array<float, 3> point{};
    if (!parse_numbers(text, point))
        throw UsageError(fmt::format("{} '{}' is no point; write three numbers as 1.5,0,-2", option, text));
    return {point[0], point[1], point[2]};
}

std::vector<Option*> add_camera_options(Command& command, CameraArguments& arguments) {
    return {
        command
            .add_option("--view", arguments.view,
                        fmt::format("where it is seen from, as large as it fits: {}", fmt::join(view_names(), ", ")))
            ->type_name("NAME")
            ->check(completion_words(view_names()))
            ->capture_default_str(),
        command.add_option("--eye", arguments.eye, "a point to see it from instead, in the units of the mesh")
            ->type_name("X,Y,Z"),
        command.add_option("--target", arguments.target, "the point that --eye looks at; default: the middle")
            ->type_name("X,Y,Z"),
        command.add_option("--up", arguments.up, "what is up in the picture; 0,0,1 for meshes that stand along z")
            ->type_name("X,Y,Z")
            ->capture_default_str(),
        command
            .add_option("--fov", arguments.field_of_view, "vertical angle of view in degrees; 0: parallel projection")
            ->capture_default_str()
            ->check(in_range(0.0, 170.0)),
        command
            .add_option("--shift", arguments.shift,
                        "moves what the camera shows to the right and up, in heights of the picture")
            ->type_name("X,Y")
            ->capture_default_str(),
        command.add_option("--size", arguments.size, "pixels of the drawing")->type_name("WxH")->capture_default_str()};
}

void require_camera(const CameraArguments& arguments) {
    size_of(arguments.size);
    require_view(arguments.view);
    if (!(point_of(arguments.up, "--up").norm() > 0)) throw UsageError("--up is zero; give a direction as 0,1,0");
    shift_of(arguments.shift);
    if (!arguments.eye.empty()) point_of(arguments.eye, "--eye");
    if (arguments.target.empty()) return;
    if (arguments.eye.empty()) throw UsageError("--target is where --eye looks; give --eye, too");
    point_of(arguments.target, "--target");
}

SizedCamera camera_of(const CameraArguments& arguments, const TriangleMesh& extent) {
    const ViewPoint point = view_point(arguments);
    return {camera_at(point, extent), point.width, point.height};
}

StrokeView view_of(const CameraArguments& arguments, LinesSource& source) {
    return stroke_view(view_point(arguments), extent_of(source), source.feature_size());
}

}  // namespace exemplar
