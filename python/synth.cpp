// Generated shapes with known labels, and generated animations.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "host/synth/animations/animations.h"
#include "host/synth/shapes/shapes.h"
#include "python/animation_object.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/long_work.h"
#include "python/mesh_object.h"

namespace exemplar::python {
namespace {

std::vector<std::string> strings(std::span<const std::string_view> names) {
    return {names.begin(), names.end()};
}

MeshPointer shape(const std::string& kind, std::uint64_t seed, std::int64_t faces) {
    require_range("faces", faces, std::int64_t{500}, std::int64_t{200'000});
    SynthShape made = long_result([&] { return make_shape(kind, seed, static_cast<std::size_t>(faces)); });
    MeshPointer object = make_mesh(std::move(made.mesh), fmt::format("{}_{:03}", kind, seed));
    object->labels = std::make_shared<const FaceLabels>(std::move(made.labels));
    return object;
}

AnimationPointer animation(const std::string& kind, std::uint64_t seed, std::uint64_t shape_seed, std::int64_t vertices,
                           std::int64_t frames) {
    require_range("vertices", vertices, std::int64_t{500}, std::int64_t{100'000});
    require_range("frames", frames, std::int64_t{1}, std::int64_t{100'000});
    return std::make_shared<AnimationObject>(long_result([&] {
        return make_animation(kind, {.vertices = static_cast<std::size_t>(vertices),
                                     .frames = static_cast<std::size_t>(frames),
                                     .shape_seed = shape_seed,
                                     .motion_seed = seed});
    }));
}

}  // namespace

void add_synth(py::module_& module) {
    module.def(
        "shape_kinds", [] { return strings(synth_kinds()); }, "The kinds of shapes that make_shape() knows.");
    module.def(
        "animation_kinds", [] { return strings(synth_animation_kinds()); },
        "The kinds of animations that make_animation() knows.");
    module.def(
        "make_shape", &shape, py::arg("kind"), py::arg("seed") = 1, py::arg("faces") = 10000,
        "Generates a shape with its true labels, of about so many faces (500 to 200,000): closed, y up, facing +z.\n"
        "The same kind, seed and faces give the same shape; another seed gives other proportions and another pose.\n"
        "Raises UsageError for an unknown kind.");
    module.def(
        "make_animation", &animation, py::arg("kind"), py::arg("seed") = 1, py::arg("shape_seed") = 1,
        py::arg("vertices") = 5000, py::arg("frames") = 120,
        "Generates an animation of about so many vertices (500 to 100,000) and so many frames, 30 a second. `seed`\n"
        "decides the motion, `shape_seed` the surface. Raises UsageError for an unknown kind.");
}

}  // namespace exemplar::python
