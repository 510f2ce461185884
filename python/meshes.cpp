// Meshes: from arrays and files, and back.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <variant>

#include "host/core/text.h"
#include "host/data/corpus.h"
#include "host/mesh/editing/simplify.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/long_work.h"
#include "python/mesh_object.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

/// Converts labels from source faces to their triangles.
std::shared_ptr<const FaceLabels> triangle_labels(const TriangleMesh& mesh, const FaceLabels& source) {
    auto labels = std::make_shared<FaceLabels>();
    labels->names = source.names;
    labels->label.resize(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) labels->label[f] = source.label[mesh.source_of(f)];
    return labels;
}

/// Converts labels from triangles to source faces, for the writers.
FaceLabels source_labels(const MeshObject& object) {
    if (!object.labels) throw UsageError(object.name + ": has no labels; give it some by with_labels()");
    return {object.labels->names, to_source_faces(*object.mesh, object.labels->label)};
}

std::vector<float> source_confidence(const MeshObject& object) {
    if (!object.confidence) return {};
    std::vector<float> confidence(object.mesh->source_face_count, 0);
    for (std::uint32_t f = 0; f < object.mesh->face_count(); ++f)
        confidence[object.mesh->source_of(f)] = (*object.confidence)[f];
    return confidence;
}

std::shared_ptr<const std::vector<float>> triangle_confidence(const TriangleMesh& mesh,
                                                              const std::vector<float>& source) {
    if (source.empty()) return nullptr;
    auto confidence = std::make_shared<std::vector<float>>(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) (*confidence)[f] = source[mesh.source_of(f)];
    return confidence;
}

MeshPointer mesh_from_arrays(const py::object& vertices, const py::object& faces, std::string name) {
    TriangleMesh mesh;
    mesh.vertices = points_of(vertices, "vertices");
    mesh.faces = faces_of(faces, "faces", mesh.vertices.size());
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
    return make_mesh(std::move(mesh), std::move(name));
}

MeshPointer read_mesh_file(const fs::path& path) {
    return long_result([&] {
        MeshFile file = read_mesh(path);
        MeshPointer object = make_mesh(std::move(file.mesh), path.string(), std::move(file.warnings));
        if (file.labels) object->labels = triangle_labels(*object->mesh, *file.labels);
        object->confidence = triangle_confidence(*object->mesh, file.confidence);
        object->polygons = std::move(file.polygons);
        return object;
    });
}

/// All meshes of some folders, lists and files, with their labels.
std::vector<MeshPointer> read_labeled(const std::variant<fs::path, std::vector<fs::path>>& sources,
                                      const fs::path& labels_folder) {
    return long_result([&] {
        const auto* const several = std::get_if<std::vector<fs::path>>(&sources);
        std::vector<fs::path> paths;
        for (const fs::path& source : several ? *several : std::vector{std::get<fs::path>(sources)})
            for (const fs::path& path : list_meshes(source))
                if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
        LabeledCorpus corpus = load_corpus(paths, {}, labels_folder);
        std::vector<MeshPointer> meshes;
        for (LabeledMesh& item : corpus.meshes) {
            MeshPointer object = make_mesh(std::move(item.mesh), item.path.string());
            object->labels = std::make_shared<const FaceLabels>(FaceLabels{corpus.names, std::move(item.label)});
            meshes.push_back(std::move(object));
        }
        return meshes;
    });
}

void write_mesh_file(const MeshObject& object, const fs::path& path) {
    const std::string extension = lower_case(path.extension().string());
    std::function<void()> writer;
    if (extension == ".off") writer = [&] { write_off(path, *object.mesh); };
    if (extension == ".obj") writer = [&] { write_obj(path, *object.mesh); };
    if (extension == ".ply")
        writer = [&] {
            const FaceLabels labels = object.labels ? source_labels(object) : FaceLabels{};
            write_ply(path, *object.mesh, object.labels ? &labels : nullptr, source_confidence(object),
                      &object.polygons);
        };
    if (extension == ".glb")
        writer = [&] {
            const FaceLabels none{{}, std::vector<std::int32_t>(object.mesh->source_face_count, -1)};
            write_gltf(path, *object.mesh, object.labels ? source_labels(object) : none);
        };
    if (!writer)
        throw UsageError(fmt::format("{}: '{}' is not written; give a name that ends in .off, .obj, .ply or .glb",
                                     path.string(), extension));
    run_long(writer);
}

/// Returns the same surface with labels and their confidence.
MeshPointer with_labels(const MeshObject& object, const py::object& labels, std::vector<std::string> names,
                        const py::object& confidence) {
    auto result = std::make_shared<MeshObject>(object);
    const std::size_t faces = object.mesh->face_count();
    std::vector<std::int32_t> label = labels_of(labels, "labels", faces, names.size());
    result->labels = std::make_shared<const FaceLabels>(FaceLabels{std::move(names), std::move(label)});
    result->confidence = nullptr;
    if (!confidence.is_none())
        result->confidence = std::make_shared<const std::vector<float>>(floats_of(confidence, "confidence", faces));
    return result;
}

/// Returns a simplified mesh of about `faces` faces, and for each original face its simplified face.
py::tuple simplified(const MeshObject& object, std::int64_t faces) {
    require_range("faces", faces, std::int64_t{4}, std::int64_t{1} << 30);
    SimplifiedMesh simple = long_result([&] {
        return named(object, [&] {
            require_usable(*object.mesh, object.name);
            return simplify_mesh(*object.mesh, static_cast<std::size_t>(faces));
        });
    });
    return py::make_tuple(make_mesh(std::move(simple.mesh), object.name), own_view(std::move(simple.face_of)));
}

py::str mesh_representation(const MeshObject& object) {
    return text(fmt::format("<exemplar.Mesh '{}': {}, {}{}>", without_controls(object.name),
                            counted(object.mesh->vertex_count(), "vertex", "vertices"),
                            counted(object.mesh->face_count(), "face"),
                            object.labels ? fmt::format(", {}", counted(object.labels->names.size(), "label")) : ""));
}

py::object labels_or_none(const MeshObject& object) {
    if (!object.labels) return py::none();
    return list_view(object.labels, object.labels->label);
}

py::object confidence_or_none(const MeshObject& object) {
    if (!object.confidence) return py::none();
    return list_view(object.confidence, *object.confidence);
}

/// The polygon of the file that each triangle is from.
py::array source_faces(const MeshObject& object) {
    if (!object.mesh->source_face.empty()) return list_view(object.mesh, object.mesh->source_face);
    std::vector<std::uint32_t> all(object.mesh->face_count());
    for (std::uint32_t f = 0; f < all.size(); ++f) all[f] = f;
    return own_view(std::move(all));
}

void add_report(py::module_& module) {
    py::class_<MeshReport, std::shared_ptr<MeshReport>> report(
        module, "MeshReport", "What is wrong or unusual about a mesh, and where: what Mesh.validate() finds.");
    const auto list = [&](const char* name, auto member, const char* doc) {
        report.def_property_readonly(
            name, [member](const std::shared_ptr<MeshReport>& self) { return list_view(self, (*self).*member); }, doc);
    };
    list("non_finite_vertices", &MeshReport::non_finite_vertices,
         "Vertices (n) with a coordinate that is no number or infinite: the mesh cannot be used.");
    list("non_manifold_edges", &MeshReport::non_manifold_edges,
         "Edges (n x 2 vertices) with more than two faces: their faces count as neighbors one after the other.");
    list("inconsistent_edges", &MeshReport::inconsistent_edges,
         "Edges (n x 2 vertices) whose two faces are of opposite orientation.");
    list("degenerate_faces", &MeshReport::degenerate_faces, "Faces (n) without area, or that name a vertex twice.");
    list("duplicate_faces", &MeshReport::duplicate_faces, "Faces (n) with the three vertices of an earlier one.");
    list("unreferenced_vertices", &MeshReport::unreferenced_vertices, "Vertices (n) that no face has.");
    report.def_readonly("boundary_edges", &MeshReport::boundary_edges, "How many edges have a single face.")
        .def_readonly("components", &MeshReport::components, "How many pieces there are that no edge connects.")
        .def_readonly("empty", &MeshReport::empty, "Whether there are no faces: the mesh cannot be used.")
        .def_readonly("inside_out", &MeshReport::inside_out, "Whether the surface is closed and its faces look inward.")
        .def_property_readonly("usable", &MeshReport::usable, "Whether the mesh can be used at all.")
        .def_property_readonly("clean", &MeshReport::clean,
                               "Whether nothing is wrong; holes and several pieces are not wrong.")
        .def_property_readonly(
            "messages", &MeshReport::messages,
            "A line for each kind of defect: what, how many, where, and what Exemplar does about it.")
        .def("__repr__", [](const MeshReport& self) {
            return fmt::format("<exemplar.MeshReport: {}>", fmt::join(self.messages(), "; "));
        });
}

using MeshClass = py::class_<MeshObject, MeshPointer>;

void add_arrays(MeshClass& mesh) {
    mesh.def_property_readonly(
            "vertices", [](const MeshObject& self) { return list_view(self.mesh, self.mesh->vertices); },
            "Positions (n x 3 float32) relative to `origin`: a read-only view, without a copy.")
        .def_property_readonly(
            "origin",
            [](const MeshObject& self) {
                const Vec3d& origin = self.mesh->origin;
                return py::make_tuple(origin[0], origin[1], origin[2]);
            },
            "What is to be added to `vertices` for the coordinates of the file (x, y, z): zero, but for files with\n"
            "geographic coordinates, which floats cannot hold.")
        .def_property_readonly(
            "faces", [](const MeshObject& self) { return list_view(self.mesh, self.mesh->faces); },
            "Vertices of each triangle (m x 3 uint32), counter-clockwise seen from outside: a read-only view.")
        .def_property_readonly(
            "labels", &labels_or_none,
            "The label of each face (m int32): its place in label_names, or -1. None without labels.")
        .def_property_readonly(
            "label_names",
            [](const MeshObject& self) { return texts(self.labels ? self.labels->names : std::vector<std::string>()); },
            "The names of the labels; empty without labels.")
        .def_property_readonly("confidence", &confidence_or_none,
                               "How sure the label of each face is (m float32, from 0 to 1), or None.")
        .def_property_readonly("source_faces", &source_faces,
                               "For each triangle (m uint32) the polygon of the file that it was cut from.")
        .def_property_readonly(
            "source_face_count", [](const MeshObject& self) { return self.mesh->source_face_count; },
            "How many polygons the file had.")
        .def_property_readonly(
            "vertex_count", [](const MeshObject& self) { return self.mesh->vertex_count(); }, "How many vertices.")
        .def_property_readonly(
            "face_count", [](const MeshObject& self) { return self.mesh->face_count(); }, "How many triangles.")
        .def_property_readonly(
            "name", [](const MeshObject& self) { return text(self.name); },
            "What messages call it: the file, or the name that was given.")
        .def_property_readonly(
            "warnings", [](const MeshObject& self) { return texts(self.warnings); },
            "What was repaired or left out when the file was read, a line each.");
}

void add_measures(MeshClass& mesh) {
    mesh.def(
            "face_areas", [](const MeshObject& self) { return own_view(face_areas(*self.mesh)); },
            "The area of each face (m float32), in squared units of the mesh.")
        .def(
            "face_centers", [](const MeshObject& self) { return own_view(face_centers(*self.mesh)); },
            "The center of each face (m x 3 float32).")
        .def(
            "face_normals", [](const MeshObject& self) { return own_view(face_normals(*self.mesh)); },
            "The unit normal of each face (m x 3 float32).")
        .def(
            "vertex_normals", [](const MeshObject& self) { return own_view(vertex_normals(*self.mesh)); },
            "The unit normal of each vertex (n x 3 float32); +z where no face has the vertex.")
        .def(
            "validate",
            [](const MeshObject& self) {
                return std::make_shared<MeshReport>(long_result([&] { return validate_mesh(*self.mesh); }));
            },
            "Looks for everything that is wrong or unusual about the mesh. Never raises: any mesh may be looked at.")
        .def("simplified", &simplified, py::arg("faces"),
             "A mesh of about so many faces, and for each face of this one the face that stands for it (m uint32).\n"
             "Raises MeshError if nothing would be left, as of loose triangles.");
}

void add_mesh(py::module_& module) {
    MeshClass mesh(
        module, "Mesh",
        "A triangle mesh, perhaps with a label for each face. It never changes: its arrays are read-only\n"
        "views (copy them to change them, and make another mesh of them), and any number of threads may use\n"
        "it at once.");
    mesh.def(
        py::init(&mesh_from_arrays), py::arg("vertices"), py::arg("faces"), py::arg("name") = "mesh",
        "Makes a mesh of positions (n x 3 numbers) and triangles (m x 3 whole numbers from 0 to n - 1,\n"
        "counter-clockwise seen from outside); both are copied. `name` is what messages call it. Raises TypeError\n"
        "for other values, UsageError for another shape or a vertex that is not there.");
    add_arrays(mesh);
    add_measures(mesh);
    mesh.def("with_labels", &with_labels, py::arg("labels"), py::arg("label_names"), py::arg("confidence") = py::none(),
             "The same surface with a label for each face (m whole numbers: places in label_names, or -1 for none), "
             "and\n"
             "maybe how sure it is (m numbers). The surface is shared, not copied.")
        .def(
            "write", &write_mesh_file, py::arg("path"),
            "Writes an .off, .obj, .ply or .glb file; the last two with labels and colors, .ply also with confidence.\n"
            "Replaces a file only when the new one is complete. Raises DataError if it cannot be written.")
        .def(
            "write_labels",
            [](const MeshObject& self, const fs::path& path) {
                run_long([&] { write_labels_txt(path, source_labels(self)); });
            },
            py::arg("path"),
            "Writes the labels as text: a line with a name, a line with the 1-based numbers of its faces, and so on.\n"
            "Raises DataError if a face has no label, UsageError if the mesh has no labels.")
        .def("__repr__", &mesh_representation);
}

}  // namespace

MeshPointer make_mesh(TriangleMesh mesh, std::string name, std::vector<std::string> warnings) {
    auto object = std::make_shared<MeshObject>();
    object->mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
    object->name = std::move(name);
    object->warnings = std::move(warnings);
    return object;
}

void add_meshes(py::module_& module) {
    add_report(module);
    add_mesh(module);
    module.def(
        "read_mesh", &read_mesh_file, py::arg("path"),
        "Reads a mesh file: OFF, OBJ, PLY, STL or glTF 2.0, by its extension; where exemplar-import is installed also\n"
        "FBX, COLLADA, 3MF and 3DS. Polygons are cut into triangles. A\n"
        "PLY with a `label` for each face comes with labels. Raises MeshError with file and line or byte.");
    module.def(
        "read_labeled", &read_labeled, py::arg("sources"), py::arg("labels_folder") = "",
        "Reads labeled meshes: of a folder, a list (a text file with a path a line) or a mesh file, or of several\n"
        "of them. The labels of NAME.off are in NAME_labels.txt beside it, or in labels_folder, or in the PLY\n"
        "itself. All meshes have the same label_names. Raises MeshError or DataError.");
}

}  // namespace exemplar::python
