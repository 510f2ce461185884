// Hatching: a style from one drawing, and drawings in it.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <optional>

#include "gpu/hatching/hatching_device.h"
#include "host/core/text.h"
#include "host/hatching/drawing/aligned_drawing.h"
#include "host/hatching/features/surface_cache.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/style/hatching_style.h"
#include "host/hatching/style/style_learning.h"
#include "host/hatching/view_hatching.h"
#include "host/imaging/pictures/picture_file.h"
#include "host/imaging/png.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/editing/loose_vertices.h"
#include "host/mesh/editing/validate.h"
#include "host/synth/hatching/hatched_drawing.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/long_work.h"
#include "python/mesh_object.h"
#include "python/views.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

using StylePointer = std::shared_ptr<HatchingStyle>;

/// A view of a mesh, and the device that measures and hatches it. One thread at a time may use it.
class Scene {
  public:
    Scene(const MeshObject& mesh, const ViewPoint& point, const Vec3& light, const fs::path& cache,
          const std::string& device)
        : device_({.name = device}),
          title_(fs::path(mesh.name).stem().string()),
          surface_(cached_surface(without_loose_vertices(drawable_mesh(*mesh.mesh, mesh.name).mesh), cache)) {
        const Camera camera = camera_at(point, surface_.mesh);
        view_ = {camera, light_from(camera, light), point.width, point.height, point.up.normalized()};
        pixels_.emplace(surface_, view_, device_.tools().images);
    }

    /// Does work on the pixels while no other thread does, without Python's lock.
    template <typename Work>
    auto use(Work&& work) {
        return long_result([&] {
            const std::lock_guard lock(mutex_);
            return work(*pixels_);
        });
    }
    const HatchingTools& tools() const { return device_.tools(); }
    const HatchingSurface& surface() const { return surface_; }
    const HatchingView& view() const { return view_; }
    const std::string& title() const { return title_; }

  private:
    HatchingDevice device_;
    std::string title_;
    HatchingSurface surface_;
    HatchingView view_;
    std::optional<PixelFeatures> pixels_;
    std::mutex mutex_;
};
using ScenePointer = std::shared_ptr<Scene>;

struct Hatched {
    HatchedDrawing drawing;
    DrawingStyle look;
    std::string title;
};
using HatchedPointer = std::shared_ptr<Hatched>;

/// A picture as an array: height x width, or height x width x channels.
py::array image_view(Image image) {
    const auto owner = std::make_shared<const Image>(std::move(image));
    std::vector<py::ssize_t> shape{owner->height, owner->width};
    if (owner->channels > 1) shape.push_back(owner->channels);
    return view(owner, owner->data.data(), shape);
}

/// A picture from an array of bytes.
Image image_of(const py::object& given, const std::string& name) {
    const auto array = py::array::ensure(given);
    if (!array || array.dtype().kind() != 'u' || array.itemsize() != 1)
        throw py::type_error(name + ": a PNG file, or an array of uint8, is needed");
    const bool gray = array.ndim() == 2;
    if (array.size() == 0 || (!gray && array.ndim() != 3))
        throw UsageError(name + ": an array of shape (height, width) or (height, width, channels) is needed");
    constexpr py::ssize_t k_most = 1 << 15;
    if (array.shape(0) > k_most || array.shape(1) > k_most)
        throw UsageError(fmt::format("{}: is larger than {} pixels a side", name, k_most));
    const auto channels = gray ? 1 : array.shape(2);
    if (channels != 1 && channels != 3 && channels != 4)
        throw UsageError(fmt::format("{}: has {} channels; give 1 (gray), 3 (RGB) or 4 (RGBA)", name, channels));
    const auto values = py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>::ensure(array);
    Image image(static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)), static_cast<int>(channels));
    std::copy_n(values.data(), image.data.size(), image.data.begin());
    return image;
}

ScenePointer make_scene(const MeshObject& mesh, const std::string& view, const py::object& eye,
                        const py::object& target, const py::object& up, double field_of_view,
                        std::pair<std::int64_t, std::int64_t> size, const py::object& light, const fs::path& cache,
                        const std::string& device) {
    const ViewPoint point = view_point_of({view, eye, target, up, field_of_view, size});
    const Vec3 direction = vector_of(light, "light");
    if (!(direction.norm() > 0)) throw UsageError("light: is zero; give a direction as (-0.5, 0.5, 0.7)");
    return long_result([&] {
        return named(mesh, [&] {
            require_usable(*mesh.mesh, mesh.name);
            return std::make_shared<Scene>(mesh, point, direction, cache, device);
        });
    });
}

py::array example(Scene& scene, const std::string& rule, std::uint64_t seed) {
    return image_view(scene.use([&](PixelFeatures& pixels) {
        const RuledDrawing drawing = draw_by_rule(rule, pixels, scene.tools().placer, seed);
        return ink_picture(drawing.ink, drawing.truth.width, drawing.truth.height);
    }));
}

StylePointer train_hatching(Scene& scene, const py::object& drawing, std::uint64_t seed) {
    const bool is_file = py::isinstance<py::str>(drawing) || py::hasattr(drawing, "__fspath__");
    const fs::path path = is_file ? drawing.cast<fs::path>() : fs::path();
    const Image given = is_file ? Image() : image_of(drawing, "drawing");
    return std::make_shared<HatchingStyle>(scene.use([&](PixelFeatures& pixels) {
        const AlignedDrawing aligned = align_and_measure(is_file ? read_picture(path) : given, pixels);
        StyleReport report;
        HatchingStyle style = learn_hatching_style(pixels, drawing_properties(aligned.strokes), scene.tools().scorer,
                                                   {.seed = seed}, report);
        style.name = is_file ? path.filename().string() : "drawing";
        return style;
    }));
}

HatchedPointer draw_hatching(Scene& scene, HatchingStyle style, const std::vector<std::string>& curves,
                             std::optional<double> taper, bool tone, std::uint64_t seed) {
    if (taper) require_range("taper", *taper, 0, 1000);
    const std::vector<LineType> types = line_types_of(curves);
    HatchingOptions options;
    options.strokes.seed = seed;
    options.matches_tone = tone;
    style.resize(scene.view().width, scene.view().height);
    return std::make_shared<Hatched>(scene.use([&](PixelFeatures& pixels) {
        const ViewHatching hatching = hatch_view(style, pixels, scene.tools(), options);
        Hatched result{
            {scene.view().width, scene.view().height, hatching.strokes, {}}, curve_look(style), scene.title()};
        taper_strokes(result.drawing.strokes, static_cast<float>(taper.value_or(style.taper)));
        result.drawing.curves = feature_curves(scene.surface(), scene.view(), types, result.look);
        return result;
    }));
}

py::list strokes(const Hatched& self) {
    py::list list;
    for (const HatchStroke& stroke : self.drawing.strokes) {
        std::vector<std::array<float, 3>> points;
        for (std::size_t i = 0; i < stroke.points.size(); ++i)
            points.push_back({stroke.points[i].x(), stroke.points[i].y(), stroke.widths[i]});
        list.append(own_view(std::move(points)));
    }
    return list;
}

/// Something of each stroke, as an array.
template <typename Value, typename Get>
py::array of_strokes(const Hatched& self, Get get) {
    std::vector<Value> values;
    for (const HatchStroke& stroke : self.drawing.strokes) values.push_back(static_cast<Value>(get(stroke)));
    return own_view(std::move(values));
}

Image picture(const Hatched& self, double scale) {
    require_range("scale", scale, 0.1, 16);
    return long_result([&] { return hatching_picture(self.drawing, self.look, static_cast<float>(scale)); });
}

void write_svg_file(const Hatched& self, const fs::path& path, bool outlines) {
    SvgOptions options;
    options.form = outlines ? SvgForm::outlines : SvgForm::lines;
    options.title = self.title;
    run_long([&] { write_hatching_svg(path, self.drawing, self.look, options); });
}

void write_hatching(const Hatched& self, const fs::path& path, bool outlines, double scale) {
    if (path.extension() == ".svg") return write_svg_file(self, path, outlines);
    if (path.extension() != ".png")
        throw UsageError(path.string() + ": is not written; give a name that ends in .svg or .png");
    const Image image = picture(self, scale);
    run_long([&] { write_png(path, image); });
}

std::string hatching_svg(const Hatched& self, bool outlines) {
    return written_text([&](const fs::path& path) { write_svg_file(self, path, outlines); });
}

void add_style(py::module_& module) {
    py::class_<HatchingStyle, StylePointer>(module, "HatchingStyle",
                                            "A style of pen-and-ink hatching, learned from one drawing.")
        .def_static(
            "load",
            [](const fs::path& path) {
                return std::make_shared<HatchingStyle>(long_result([&] { return load_hatching_style(path); }));
            },
            py::arg("path"), "Reads a style file, and checks it completely. Raises ModelError.")
        .def(
            "save",
            [](const HatchingStyle& self, const fs::path& path) { run_long([&] { save_hatching_style(path, self); }); },
            py::arg("path"), "Writes the style as a .safetensors file, which the programs read, too.")
        .def("describe", &describe_hatching_style,
             "The style in words: which rule hatches which segment, and what drives each property.")
        .def_readonly("name", &HatchingStyle::name, "Of the drawing.")
        .def("__repr__", [](const HatchingStyle& self) {
            return fmt::format("<exemplar.HatchingStyle '{}': {}>", without_controls(self.name),
                               counted(self.rules.size(), "segment"));
        });
}

void add_hatched(py::module_& module) {
    py::class_<Hatched, HatchedPointer>(module, "HatchedDrawing", "A view hatched in a style; notebooks show it.")
        .def_property_readonly(
            "size", [](const Hatched& self) { return py::make_tuple(self.drawing.width, self.drawing.height); },
            "Width and height in pixels.")
        .def_property_readonly(
            "strokes", &strokes,
            "A list of arrays (n x 3 float32): of each point of a stroke x and y in pixels (y down, from\n"
            "the upper left corner) and the width in pixels.")
        .def_property_readonly(
            "layers",
            [](const Hatched& self) {
                return of_strokes<std::uint8_t>(self, [](const HatchStroke& stroke) { return stroke.layer; });
            },
            "Of each stroke (uint8) 0 for a hatch, 1 for a cross-hatch.")
        .def_property_readonly(
            "darkness",
            [](const Hatched& self) {
                return of_strokes<float>(self, [](const HatchStroke& stroke) { return stroke.darkness; });
            },
            "Of each stroke (float32) how dark it is, from 0 to 1.")
        .def("svg", &hatching_svg, py::kw_only(), py::arg("outlines") = false,
             "The drawing as the text of an SVG file. `outlines`: filled shapes of varying width, not center lines.")
        .def(
            "image", [](const Hatched& self, double scale) { return image_view(picture(self, scale)); }, py::kw_only(),
            py::arg("scale") = 1.0,
            "The drawing as a picture (height x width, or height x width x 3, uint8), `scale` times as large (0.1 to "
            "16).")
        .def("write", &write_hatching, py::arg("path"), py::kw_only(), py::arg("outlines") = false,
             py::arg("scale") = 1.0,
             "Writes the drawing as an .svg or .png file. Raises DataError if it cannot be written.")
        .def("_repr_svg_", [](const Hatched& self) { return hatching_svg(self, false); })
        .def("__repr__", [](const Hatched& self) {
            return fmt::format("<exemplar.HatchedDrawing {} x {}: {}>", self.drawing.width, self.drawing.height,
                               counted(self.drawing.strokes.size(), "stroke"));
        });
}

void add_scene(py::module_& module) {
    const ViewPoint usual;
    const std::string doc =
        std::string("Measures a mesh (seconds to minutes) and opens a device.\n") + k_view_doc +
        "`light`: direction to the light as the eye has it: to the right, up, towards the eye. `cache`: a folder that\n"
        "remembers measured surfaces (see surface_folder()); empty: nothing is remembered. `device` as in\n"
        "LabelingModel.label(). Raises UsageError, MeshError, DataError if nothing of the mesh is seen, or "
        "DeviceError.";
    py::class_<Scene, ScenePointer>(
        module, "HatchingScene",
        "A view of a mesh to learn a style from, or to draw in one. Threads that use it wait for\n"
        "each other.")
        .def(py::init(&make_scene), py::arg("mesh"), py::kw_only(), py::arg("view") = usual.view,
             py::arg("eye") = py::none(), py::arg("target") = py::none(), py::arg("up") = py::make_tuple(0, 1, 0),
             py::arg("field_of_view") = usual.field_of_view, py::arg("size") = std::pair(1000, 1000),
             py::arg("light") = py::make_tuple(-0.45, 0.55, 0.7), py::arg("cache") = "", py::arg("device") = "",
             doc.c_str())
        .def_property_readonly(
            "size", [](const Scene& self) { return py::make_tuple(self.view().width, self.view().height); },
            "Width and height in pixels.")
        .def(
            "template", [](Scene& self) { return image_view(self.use(&drawing_template)); },
            "The shaded view (height x width uint8), light enough to draw on: trace it with strokes only.")
        .def("example", &example, py::arg("rule"), py::arg("seed") = 1,
             "The view drawn by a rule of hatching_rules() (height x width uint8), as if by hand. Raises UsageError.")
        .def("train", &train_hatching, py::arg("drawing"), py::kw_only(), py::arg("seed") = 1,
             "Learns a style from a drawing of this view: strokes only, dark on light, of any resolution: a PNG file "
             "or an\n"
             "array (height x width, or with 3 or 4 channels, uint8). Equal seeds give equal styles. Raises DataError "
             "if the\n"
             "drawing is blank or does not fit the view.")
        .def("draw", &draw_hatching, py::arg("style"), py::kw_only(),
             py::arg("curves") = std::vector<std::string>{"contours"}, py::arg("taper") = py::none(),
             py::arg("tone") = true, py::arg("seed") = 1,
             "Hatches the view in a style. `curves`: types of lines drawn with it, see line_types(). `taper`: pixels "
             "over\n"
             "which strokes end in a point (0 to 1000); None: as in the style's drawing. `tone`: whether the thickness "
             "is matched to the tone. `seed` "
             "of the\n"
             "placement of strokes.")
        .def("__repr__", [](const Scene& self) {
            return fmt::format("<exemplar.HatchingScene of '{}': {} x {}>", without_controls(self.title()),
                               self.view().width, self.view().height);
        });
}

}  // namespace

void add_hatching(py::module_& module) {
    add_style(module);
    add_hatched(module);
    add_scene(module);
    module.def(
        "hatching_rules",
        [] { return std::vector<std::string>(hatching_rule_names().begin(), hatching_rule_names().end()); },
        "The rules that HatchingScene.example() draws by.");
}

}  // namespace exemplar::python
