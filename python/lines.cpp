// Line drawings of meshes: as SVG, and as arrays of points.

#include "host/lines/extraction/lines.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "host/core/text.h"
#include "host/lines/drawing.h"
#include "host/lines/drawing_svg.h"
#include "host/lines/extraction/drawable_surface.h"
#include "host/lines/strokes/style.h"
#include "host/lines/strokes/view_point.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/editing/loose_vertices.h"
#include "host/mesh/editing/validate.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/curvature_object.h"
#include "python/long_work.h"
#include "python/mesh_object.h"
#include "python/views.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

/// Types, style, view and measurement of the lines to draw.
struct LinesJob {
    std::vector<LineType> types;
    DrawingStyle style;
    ViewPoint view;
    double smoothing = 1;
    std::optional<float> feature_size;
};

struct LineDrawing {
    Drawing drawing;
    DrawingStyle style;
    StrokeView view;
    std::string title;
};
using LineDrawingPointer = std::shared_ptr<LineDrawing>;

LineDrawing drawn(const LinesJob& job, const MeshObject& mesh, const LineSurface& surface, float measured_size) {
    const float size = job.feature_size ? *job.feature_size : measured_size;
    if (!(size > 0))
        throw MeshError(mesh.name + ": has no extent, all vertices are at one place; there is nothing to draw");
    const TriangleMesh extent = without_loose_vertices(*mesh.mesh);
    const StrokeView view = stroke_view(job.view, extent, size);
    return {draw_lines(surface, job.types, job.style, view), job.style, view, fs::path(mesh.name).stem().string()};
}

/// By curvature that is measured here.
LineDrawing draw_measured(const LinesJob& job, const MeshObject& mesh) {
    const DrawableMesh drawable = drawable_mesh(*mesh.mesh, mesh.name);
    const DrawableOptions options{
        .curvature = {.derivatives = std::ranges::any_of(job.types, needs_curvature), .smoothing = job.smoothing},
        .crease_angle = job.style.thresholds(LineType::creases).crease_angle,
        .cut_curvature = std::ranges::find(job.types, LineType::creases) != job.types.end()};
    DrawableSurface surface(drawable.mesh.faces, drawable.mesh.vertices, options);
    surface.measure(drawable.mesh.vertices);
    return drawn(job, mesh, surface.surface(), surface.feature_size());
}

/// By curvature that is given, of the vertices as they are.
LineDrawing draw_given(const LinesJob& job, const MeshObject& mesh, const VertexCurvature& curvature) {
    if (curvature.k1.size() != mesh.mesh->vertex_count())
        throw UsageError(fmt::format("curvature: is of {} vertices, but the mesh has {}", curvature.k1.size(),
                                     mesh.mesh->vertex_count()));
    if (curvature.derivative.empty() && std::ranges::any_of(job.types, needs_curvature))
        throw UsageError("curvature: has no derivatives, which these types of lines need");
    require_drawable(*mesh.mesh, mesh.name);
    const std::vector<Vec3> normals = vertex_normals(*mesh.mesh);
    DrawableSurface cut(mesh.mesh->faces, mesh.mesh->vertices,
                        {.crease_angle = job.style.thresholds(LineType::creases).crease_angle});
    cut.take(mesh.mesh->vertices, normals, curvature);
    return drawn(job, mesh, cut.surface(), feature_size(mesh.mesh->vertices, curvature));
}

void set_thresholds(DrawingStyle& style, const std::map<std::string, float>& thresholds) {
    for (const auto& [word, value] : thresholds)
        for (const LineType type : line_types_of({word})) {
            LineThresholds checked;
            set_threshold(checked, type, value);
            style.of(type).threshold = value;
        }
}

// One parameter for each keyword of the Python function. NOLINTNEXTLINE(readability-function-size)
LineDrawingPointer draw_lines(const MeshObject& mesh, const std::vector<std::string>& types, const std::string& style,
                              const std::string& view, const py::object& eye, const py::object& target,
                              const py::object& up, double field_of_view, std::pair<std::int64_t, std::int64_t> size,
                              const std::map<std::string, float>& thresholds, double smoothing,
                              const CurvaturePointer& curvature, std::optional<float> wanted_feature_size) {
    require_range("smoothing", smoothing, 0, 100);
    if (wanted_feature_size) require_range("feature_size", *wanted_feature_size, 1e-30, 1e30);
    LinesJob job{line_types_of(types), load_style(style), view_point_of({view, eye, target, up, field_of_view, size}),
                 smoothing, wanted_feature_size};
    set_thresholds(job.style, thresholds);
    return std::make_shared<LineDrawing>(
        long_result([&] { return curvature ? draw_given(job, mesh, *curvature) : draw_measured(job, mesh); }));
}

/// The visible parts of all lines of a type, each n x 4.
py::list polylines(const LineDrawing& self, const std::string& word) {
    const std::vector<LineType> types = line_types_of({word});
    py::list list;
    for (const DrawingLayer& layer : self.drawing.layers) {
        if (std::ranges::find(types, layer.type) == types.end()) continue;
        for (const Stroke& stroke : layer.strokes)
            for (const StrokeRun& run : visible_runs(stroke)) {
                std::vector<std::array<float, 4>> points;
                for (const StrokePoint& p : run.points)
                    points.push_back({p.position.x(), p.position.y(), p.width, p.opacity});
                list.append(own_view(std::move(points)));
            }
    }
    return list;
}

SvgOptions svg_options(const LineDrawing& self, bool outlines, bool curves, bool background, double tolerance) {
    require_range("tolerance", tolerance, 0, 100);
    SvgOptions options;
    options.form = outlines ? SvgForm::outlines : SvgForm::lines;
    options.fading = outlines ? SvgFading::width : SvgFading::opacity;
    options.curves = curves;
    options.background = background;
    options.tolerance = static_cast<float>(tolerance);
    options.title = self.title;
    return options;
}

void write_lines(const LineDrawing& self, const fs::path& path, bool outlines, bool curves, bool background,
                 double tolerance) {
    const SvgOptions options = svg_options(self, outlines, curves, background, tolerance);
    run_long([&] { write_drawing_svg(path, std::span(&self.drawing, 1), self.style, options); });
}

std::string lines_svg(const LineDrawing& self, bool outlines, bool curves, bool background, double tolerance) {
    return written_text(
        [&](const fs::path& path) { write_lines(self, path, outlines, curves, background, tolerance); });
}

using DrawingClass = py::class_<LineDrawing, LineDrawingPointer>;

void add_svg(DrawingClass& drawing) {
    const auto with_options = [&](const char* name, auto function, const char* doc, auto... path) {
        drawing.def(name, function, path..., py::kw_only(), py::arg("outlines") = false, py::arg("curves") = false,
                    py::arg("background") = true, py::arg("tolerance") = 0.1, doc);
    };
    with_options(
        "svg", &lines_svg,
        "The drawing as the text of an SVG file, with a layer for each type of lines. `outlines`: filled shapes of\n"
        "varying width, not center lines with a stroke width. `curves`: center lines that stay smooth enlarged.\n"
        "`background`: of the style, if it has one. `tolerance`: pixels that simplified paths may be off (0 to 100).");
    with_options("write", &write_lines, "Writes the drawing as an SVG file; options as of svg(). Raises DataError.",
                 py::arg("path"));
    drawing.def("_repr_svg_", [](const LineDrawing& self) { return lines_svg(self, false, false, true, 0.1); });
}

}  // namespace

void add_lines(py::module_& module) {
    DrawingClass drawing(module, "LineDrawing",
                         "A line drawing of a mesh, without what is hidden; notebooks show it. See draw_lines().");
    drawing
        .def_property_readonly(
            "size", [](const LineDrawing& self) { return py::make_tuple(self.drawing.width, self.drawing.height); },
            "Width and height in pixels.")
        .def_property_readonly(
            "types",
            [](const LineDrawing& self) {
                std::vector<std::string> names;
                for (const DrawingLayer& layer : self.drawing.layers) names.emplace_back(name_of(layer.type));
                return names;
            },
            "The types of lines, in the order in which they are drawn.")
        .def_property_readonly(
            "view_projection",
            [](const LineDrawing& self) {
                using Rows = std::vector<std::array<float, 4>>;
                const Eigen::Matrix4f matrix = self.view.camera.view_projection();
                Rows rows(4);
                for (int r = 0; r < 4; ++r)
                    for (int c = 0; c < 4; ++c)
                        rows[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = matrix(r, c);
                return own_view(std::move(rows));
            },
            "The camera (4 x 4 float32): multiplied with (x, y, z, 1) it gives x and y from -1 to 1, y down, after\n"
            "division by the fourth.")
        .def_property_readonly(
            "feature_size", [](const LineDrawing& self) { return self.view.feature_size; },
            "The unit of length that thresholds count in, in units of the mesh.")
        .def("polylines", &polylines, py::arg("type") = "all",
             "What is visible of the lines of a type, or of all: a list of arrays (n x 4 float32), of each point x and "
             "y in\n"
             "pixels (y down, from the upper left corner), width in pixels and opacity from 0 to 1.")
        .def("__repr__", [](const LineDrawing& self) {
            return fmt::format("<exemplar.LineDrawing {} x {}: {}>", self.drawing.width, self.drawing.height,
                               counted(self.drawing.layers.size(), "type"));
        });
    add_svg(drawing);
    module.def("line_types", &line_type_names, "The types of lines that draw_lines() knows.");
    const ViewPoint usual;
    const std::string doc =
        std::string(
            "Draws a mesh in lines, on the CPU. `types`: see line_types(), or \"all\". `style`: a built-in one "
            "(\"ink\",\n"
            "\"pencil\", \"technical\" and others) or a style file.\n") +
        k_view_doc +
        "`thresholds`: how strong lines of a type must be, as {\"valleys\": 0.2}; of creases the angle in degrees.\n"
        "`smoothing`: width, in edge lengths, that measured curvature is smoothed with (0 to 100). `curvature`: what "
        "to\n"
        "draw by instead of measuring, of the same vertices: with derivatives, measured or learned. `feature_size`: "
        "the\n"
        "unit of thresholds, in units of the mesh; None: that of this mesh. Give the same for all frames of an "
        "animation,\n"
        "so that lines do not flicker. Raises UsageError for an argument that is not allowed, DataError for a style "
        "that\n"
        "is none, MeshError for a mesh that cannot be used.";
    module.def("draw_lines", &draw_lines, py::arg("mesh"), py::kw_only(),
               py::arg("types") = std::vector<std::string>{"contours", "suggestive_contours", "boundaries"},
               py::arg("style") = "ink", py::arg("view") = usual.view, py::arg("eye") = py::none(),
               py::arg("target") = py::none(), py::arg("up") = py::make_tuple(0, 1, 0),
               py::arg("field_of_view") = usual.field_of_view, py::arg("size") = std::pair(usual.width, usual.height),
               py::arg("thresholds") = std::map<std::string, float>(), py::arg("smoothing") = 1.0,
               py::arg("curvature") = py::none(), py::arg("feature_size") = py::none(), doc.c_str());
}

}  // namespace exemplar::python
