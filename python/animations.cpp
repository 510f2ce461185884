// Animations: from files and arrays, and the surface at each frame.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "host/animation/check_animation.h"
#include "host/animation/read_animation.h"
#include "host/animation/write_animation.h"
#include "host/core/text.h"
#include "python/animation_object.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/long_work.h"
#include "python/mesh_object.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

AnimationPointer read_animation_file(const fs::path& path, double frames_per_second) {
    require_range("frames_per_second", frames_per_second, 0.1, 1000);
    return std::make_shared<AnimationObject>(
        long_result([&] { return read_animation(path, {.frames_per_second = frames_per_second}); }));
}

/// The positions of all frames (t x n x 3), one list a frame.
std::vector<std::vector<Vec3>> frames_of_array(const py::object& given) {
    const py::array positions = numbers(given, "frames", "fiu", {-1, -1, 3});
    if (positions.ndim() != 3 || positions.shape(0) == 0) throw UsageError("frames: there is none; give one or more");
    std::vector<std::vector<Vec3>> frames;
    for (py::ssize_t t = 0; t < positions.shape(0); ++t)
        frames.push_back(points_of(positions[py::int_(t)], fmt::format("frames[{}]", t)));
    return frames;
}

AnimationPointer animation_from_arrays(const py::object& frames, const py::object& faces, double frames_per_second,
                                       std::string name) {
    require_range("frames_per_second", frames_per_second, 0.1, 1000);
    Clip clip;
    clip.name = name;
    clip.frames_per_second = frames_per_second;
    clip.frames = frames_of_array(frames);
    Animation animation;
    animation.name = std::move(name);
    animation.rest.vertices = clip.frames.front();
    animation.rest.faces = faces_of(faces, "faces", animation.rest.vertices.size());
    animation.rest.source_face_count = static_cast<std::uint32_t>(animation.rest.faces.size());
    for (std::uint32_t v = 0; v < animation.rest.vertex_count(); ++v) animation.vertex_of_source.push_back(v);
    animation.clips.push_back(std::move(clip));
    run_long([&] { check_animation(animation); });
    return std::make_shared<AnimationObject>(std::move(animation));
}

std::vector<Vec3> vertices_at(const AnimationObject& self, std::int64_t frame) {
    const FrameRef ref = frame_of(self, frame);
    return frame_vertices(self.animation, self.animation.clips[ref.clip], ref.frame);
}

/// The surface at a frame.
MeshPointer mesh_at(const AnimationObject& self, std::int64_t frame) {
    TriangleMesh mesh = self.animation.rest;
    mesh.vertices = vertices_at(self, frame);
    return make_mesh(std::move(mesh), fmt::format("{}, frame {}", self.animation.name, frame));
}

void write_animation_file(const AnimationObject& self, const fs::path& path) {
    run_long([&] {
        if (path.extension() == ".glb")
            write_gltf_animation(path, self.animation);
        else
            write_sequence(path, self.animation);
    });
}

py::list clips(const AnimationObject& self) {
    py::list list;
    for (const Clip& clip : self.animation.clips) list.append(py::make_tuple(clip.name, clip.size()));
    return list;
}

}  // namespace

FrameRef frame_of(const AnimationObject& self, std::int64_t frame) {
    const auto count = static_cast<std::int64_t>(self.frames.size());
    if (frame < 0 || frame >= count)
        throw UsageError(fmt::format("frame: {} is none of the frames of '{}', which are numbered from 0 to {}", frame,
                                     self.animation.name, count - 1));
    return self.frames[static_cast<std::size_t>(frame)];
}

void add_animations(py::module_& module) {
    py::class_<AnimationObject, AnimationPointer>(
        module, "Animation",
        "A surface that deforms: the same faces, other positions in each frame. It never changes. The frames of all\n"
        "clips are numbered from 0, one clip after the other.")
        .def(
            py::init(&animation_from_arrays), py::arg("frames"), py::arg("faces"), py::kw_only(),
            py::arg("frames_per_second") = 30.0, py::arg("name") = "animation",
            "Makes an animation of the positions in each frame (t x n x 3 numbers) and triangles (m x 3 whole numbers\n"
            "from 0 to n - 1). Raises UsageError for other shapes or vertices that are not there, MeshError if a\n"
            "frame cannot be used.")
        .def_property_readonly(
            "name", [](const AnimationObject& self) { return self.animation.name; }, "What messages call it.")
        .def_property_readonly(
            "kind", [](const AnimationObject& self) { return std::string(name_of(self.animation.kind)); },
            "How it is posed: \"skeleton\", \"blend shapes\" or \"mesh sequence\".")
        .def_property_readonly("clips", &clips, "The name and the number of frames of each clip.")
        .def_property_readonly(
            "frame_count", [](const AnimationObject& self) { return self.frames.size(); }, "Frames of all clips.")
        .def_property_readonly(
            "vertex_count", [](const AnimationObject& self) { return self.animation.rest.vertex_count(); },
            "How many vertices.")
        .def_property_readonly(
            "faces", [](const AnimationPointer& self) { return list_view(self, self->animation.rest.faces); },
            "Vertices of each triangle (m x 3 uint32): a read-only view.")
        .def_property_readonly(
            "warnings", [](const AnimationObject& self) { return self.animation.warnings; },
            "What was repaired or left out, a line each.")
        .def(
            "vertices",
            [](const AnimationObject& self, std::int64_t frame) { return own_view(vertices_at(self, frame)); },
            py::arg("frame"), "Positions in a frame (n x 3 float32). Raises UsageError if there is no such frame.")
        .def("mesh", &mesh_at, py::arg("frame"), "The surface in a frame. Raises UsageError if there is no such frame.")
        .def("write", &write_animation_file, py::arg("path"),
             "Writes a skeleton or blend shapes as .glb; anything as a folder of .ply files, one a frame.")
        .def("__repr__", [](const AnimationObject& self) {
            return fmt::format("<exemplar.Animation '{}': {}, {}, {}>", without_controls(self.animation.name),
                               name_of(self.animation.kind),
                               counted(self.animation.rest.vertex_count(), "vertex", "vertices"),
                               counted(self.frames.size(), "frame"));
        });
    module.def("read_animation", &read_animation_file, py::arg("path"), py::kw_only(),
               py::arg("frames_per_second") = 30.0,
               "Reads an animation: a glTF file with a skin or morph targets (where exemplar-import is installed also "
               "an FBX or\n"
               "COLLADA file), a folder with a mesh a frame, or a folder of blend shapes. Clips of files are sampled "
               "at frames_per_second (0.1 to 1000). Raises MeshError.");
}

}  // namespace exemplar::python
