#include "host/mesh/label_files/label_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"
#include "host/mesh/label_files/label_formats.h"
#include "host/mesh/label_files/vertex_labels.h"

namespace exemplar {
namespace label_files {

void fail(const std::string& name, const std::string& message) {
    throw DataError(name + ": " + message);
}

FaceLabels labels_of_numbers(const std::vector<std::int64_t>& numbers, const std::vector<std::string>& names,
                             const TriangleMesh& mesh, const std::string& name) {
    const std::size_t faces = mesh_io::source_faces(mesh);
    if (numbers.size() != faces && numbers.size() != mesh.vertex_count())
        fail(name, fmt::format("has {} labels, but the mesh has {} and {}", numbers.size(), counted(faces, "face"),
                               counted(mesh.vertex_count(), "vertex", "vertices")));
    const std::set<std::int64_t> used(numbers.begin(), numbers.end());
    if (*used.begin() < -1) fail(name, fmt::format("{} is no label; -1 stands for none", *used.begin()));
    const bool has_names = !names.empty() && *used.rbegin() < static_cast<std::int64_t>(names.size());
    FaceLabels labels;
    std::map<std::int64_t, std::int32_t> index{{-1, -1}};
    if (has_names) labels.names = names;
    for (const std::int64_t number : used) {
        if (number < 0) continue;
        index[number] = static_cast<std::int32_t>(has_names ? number : static_cast<std::int64_t>(labels.names.size()));
        if (!has_names) labels.names.push_back(std::to_string(number));
    }
    std::vector<std::int32_t> label;
    label.reserve(numbers.size());
    for (const std::int64_t number : numbers) label.push_back(index[number]);
    labels.label = numbers.size() == faces ? std::move(label) : labels_of_faces(mesh, label);
    return labels;
}

}  // namespace label_files

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 5> k_label_forms{"json", "npy", "vtp", "vertices", "vertices-json"};

/// Returns the names in NAME.names beside NAME.seg; none if there is no such file.
std::vector<std::string> names_of_segments(const fs::path& seg) {
    const fs::path path = fs::path(seg).replace_extension(".names");
    std::error_code ignored;
    if (!fs::exists(path, ignored)) return {};
    return label_files::read_name_lines(read_file(path), path.string());
}

/// Throws if labels are not of the faces of the mesh.
FaceLabels of_mesh(FaceLabels labels, const TriangleMesh& mesh, const fs::path& path) {
    if (labels.label.size() != mesh_io::source_faces(mesh))
        throw DataError(fmt::format("{}: labels {} faces, but the mesh has {}", path.string(), labels.label.size(),
                                    mesh_io::source_faces(mesh)));
    return labels;
}

std::size_t count_of_used(const FaceLabels& labels) {
    return std::set<std::int32_t>(labels.label.begin(), labels.label.end()).size();
}

std::string text_of_vertices(const TriangleMesh& mesh, const FaceLabels& labels) {
    std::string text;
    for (const std::int32_t label : labels_of_vertices(mesh, labels.label)) {
        mesh_io::append_number(text, label);
        text += '\n';
    }
    return text;
}

/// Reads labels as read_face_labels does.
FaceLabels read_labels(const fs::path& path, const TriangleMesh& mesh, label_files::GltfJoints joints) {
    const std::string extension = lower_case(path.extension().string()), name = path.string();
    const std::size_t faces = mesh_io::source_faces(mesh);
    if (faces == 0 || mesh.vertices.empty()) throw DataError(name + ": the mesh has no faces to label");
    if (extension == ".json") return label_files::read_json_labels(read_file(path), mesh, name);
    if (extension == ".npy") return label_files::read_npy_labels(read_file(path), mesh, name);
    if (extension == ".vtp") return label_files::read_vtp_labels(read_file(path), mesh, name);
    if (extension == ".seg") return label_files::read_segments(read_file(path), names_of_segments(path), mesh, name);
    if (extension == ".obj") return label_files::read_obj_groups(read_file(path), mesh, name);
    const bool is_gltf = extension == ".gltf" || extension == ".glb";
    if (std::ranges::find(mesh_extensions(), extension) == mesh_extensions().end()) {
        const std::string content = read_file(path);
        return label_files::is_number_list(content) ? label_files::read_number_list(content, mesh, name)
                                                    : read_labels_txt(path, faces);
    }
    const MeshFile file = read_mesh(path);
    if (!file.labels && is_gltf)
        return label_files::read_gltf_labels(read_file(path), path.parent_path(), mesh, name, joints);
    if (!file.labels)
        throw DataError(fmt::format("{}: has no labels of faces; a PLY has them as a property 'label'", name));
    return of_mesh(*file.labels, mesh, path);
}

}  // namespace

FaceLabels read_face_labels(const fs::path& path, const TriangleMesh& mesh) {
    return read_labels(path, mesh, label_files::GltfJoints::are_labels);
}

std::optional<FaceLabels> find_other_labels(const fs::path& mesh_path, const TriangleMesh& mesh) {
    const fs::path stem = fs::path(mesh_path).replace_extension();
    const auto is_there = [](const fs::path& path) {
        std::error_code ignored;
        return fs::is_regular_file(path, ignored);
    };
    for (const char* ending : {"_labels.json", "_labels.npy", ".vtp", ".json"})
        if (const fs::path path = stem.string() + ending; is_there(path)) return read_face_labels(path, mesh);
    if (const fs::path seg = stem.string() + ".seg"; is_there(seg) && is_there(stem.string() + ".names"))
        return read_face_labels(seg, mesh);
    const std::string extension = lower_case(mesh_path.extension().string());
    if (extension != ".obj" && extension != ".gltf" && extension != ".glb") return {};
    try {
        FaceLabels labels = read_labels(mesh_path, mesh, label_files::GltfJoints::are_none);
        if (count_of_used(labels) < 2) return {};
        return labels;
    } catch (const DataError&) {  // it has no names for its faces
        return {};
    }
}

std::span<const std::string_view> label_forms() {
    return k_label_forms;
}

fs::path write_label_file(const fs::path& stem, std::string_view form, const MeshFile& file, const FaceLabels& labels) {
    mesh_io::check_labels(file.mesh, labels);
    std::string ending, bytes;
    if (form == "json")
        ending = "_labels.json", bytes = label_files::json_of_labels(file.mesh, labels);
    else if (form == "npy")
        ending = "_labels.npy", bytes = label_files::npy_of_labels(labels);
    else if (form == "vtp")
        ending = ".vtp", bytes = label_files::vtp_of_labels(file, labels);
    else if (form == "vertices")
        ending = "_vertices.txt", bytes = text_of_vertices(file.mesh, labels);
    else if (form == "vertices-json")
        ending = "_vertices.json", bytes = label_files::json_of_vertices(file.mesh, labels);
    else
        throw UsageError(fmt::format("labels are written as {}, not as '{}'", fmt::join(k_label_forms, ", "), form));
    fs::path path = stem.string() + ending;
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
    return path;
}

}  // namespace exemplar
