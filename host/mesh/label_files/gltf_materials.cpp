// The numbers of vertices in a glTF file, or its materials, as labels of its triangles.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cmath>
#include <map>
#include <optional>

#include "host/core/errors.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/gltf/gltf_surface.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_formats.h"

namespace exemplar::label_files {
namespace {

/// The name of a material, or its number if it has none that a label can have.
std::string material_name(const tinygltf::Model& model, int material) {
    const std::string& name = model.materials[static_cast<std::size_t>(material)].name;
    return mesh_io::is_label_name(name) ? name : fmt::format("material {}", material);
}

/// Returns per triangle the number that most of its corners have (the first corner's, if all differ), -1 for none;
/// nothing if vertices have no numbers, or others than labels.
std::optional<std::vector<std::int64_t>> numbers_of_triangles(const mesh_io::GltfSurface& surface) {
    if (surface.vertex_values.empty()) return {};
    for (const float value : surface.vertex_values)
        if (!std::isnan(value) && (value < -1 || value > 1e6F || value != std::floor(value))) return {};
    std::vector<std::int64_t> numbers;
    numbers.reserve(surface.faces.size());
    for (const Face& face : surface.faces) {
        const auto at = [&](std::size_t i) {
            const float value = surface.vertex_values[face[i]];
            return std::isnan(value) ? std::int64_t{-1} : static_cast<std::int64_t>(value);
        };
        numbers.push_back(at(1) == at(2) ? at(1) : at(0));
    }
    return numbers;
}

}  // namespace

FaceLabels read_gltf_materials(std::string_view content, const std::filesystem::path& folder, const TriangleMesh& mesh,
                               const std::string& name) {
    const tinygltf::Model model = mesh_io::load_gltf(content, name, folder, mesh_io::GltfContent::still);
    mesh_io::GltfReader gltf(model, name);
    const mesh_io::GltfSurface surface = mesh_io::read_gltf_surface(gltf, name);
    if (surface.materials.size() != mesh_io::source_faces(mesh))
        fail(name, fmt::format("has {} triangles, but the mesh has {} faces", surface.materials.size(),
                               mesh_io::source_faces(mesh)));
    if (const auto numbers = numbers_of_triangles(surface)) return labels_of_numbers(*numbers, {}, mesh, name);
    FaceLabels labels;
    std::map<std::string, std::int32_t> index;  // materials of one name are one label
    labels.label.reserve(surface.materials.size());
    for (const int material : surface.materials) {
        if (material < 0 || static_cast<std::size_t>(material) >= model.materials.size()) {
            labels.label.push_back(-1);
            continue;
        }
        const auto [it, is_new] =
            index.try_emplace(material_name(model, material), static_cast<std::int32_t>(labels.names.size()));
        if (is_new) labels.names.push_back(it->first);
        labels.label.push_back(it->second);
    }
    if (labels.names.empty()) fail(name, "has no materials that could be labels of its faces");
    return labels;
}

}  // namespace exemplar::label_files
