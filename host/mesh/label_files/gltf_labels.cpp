// The numbers of vertices in a glTF file, its materials, or its joints, as labels of its triangles.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
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

/// Collects names as labels: triangles with equal names have one label.
class NamedLabels {
  public:
    void add(const std::string& name) {
        const auto [it, is_new] = index_.try_emplace(name, static_cast<std::int32_t>(labels_.names.size()));
        if (is_new) labels_.names.push_back(name);
        labels_.label.push_back(it->second);
    }
    void add_none() { labels_.label.push_back(-1); }
    const FaceLabels& labels() const { return labels_; }

  private:
    FaceLabels labels_;
    std::map<std::string, std::int32_t> index_;
};

FaceLabels labels_of_materials(const tinygltf::Model& model, const mesh_io::GltfSurface& surface) {
    NamedLabels labels;
    for (const int material : surface.materials) {
        if (material < 0 || static_cast<std::size_t>(material) >= model.materials.size())
            labels.add_none();
        else
            labels.add(material_name(model, material));
    }
    return labels.labels();
}

/// The name of a node, or its number if it has none that a label can have.
std::string node_name(const tinygltf::Model& model, std::uint32_t node) {
    const std::string& name = model.nodes[node].name;
    return mesh_io::is_label_name(name) ? name : fmt::format("joint {}", node);
}

/// Labels each triangle by the joint with the largest weight, summed over its corners. Programs export groups of
/// vertices so, as Blender does.
FaceLabels labels_of_joints(const tinygltf::Model& model, const mesh_io::GltfSurface& surface) {
    NamedLabels labels;
    for (const Face& face : surface.faces) {
        std::map<std::uint32_t, float> weight;  // of nodes
        for (const std::uint32_t corner : face)
            for (const Influence& influence : surface.skin.influences_of(corner))
                weight[surface.skin.bones.at(influence.bone).node] += influence.weight;
        const auto heaviest =
            std::ranges::max_element(weight, [](const auto& a, const auto& b) { return a.second < b.second; });
        if (heaviest == weight.end() || !(heaviest->second > 0))
            labels.add_none();
        else
            labels.add(node_name(model, heaviest->first));
    }
    return labels.labels();
}

bool has_skin(const mesh_io::GltfSurface& surface) {
    return std::ranges::any_of(surface.bones_of_skin, [](const auto& bones) { return !bones.empty(); });
}

}  // namespace

FaceLabels read_gltf_labels(std::string_view content, const std::filesystem::path& folder, const TriangleMesh& mesh,
                            const std::string& name, GltfJoints joints) {
    const tinygltf::Model model = mesh_io::load_gltf(content, name, folder, mesh_io::GltfContent::still);
    mesh_io::GltfReader gltf(model, name);
    const mesh_io::GltfSurface surface = mesh_io::read_gltf_surface(gltf, name);
    if (surface.materials.size() != mesh_io::source_faces(mesh))
        fail(name, fmt::format("has {} triangles, but the mesh has {} faces", surface.materials.size(),
                               mesh_io::source_faces(mesh)));
    if (const auto numbers = numbers_of_triangles(surface)) return labels_of_numbers(*numbers, {}, mesh, name);
    FaceLabels labels = labels_of_materials(model, surface);
    if (joints == GltfJoints::are_labels && labels.names.size() < 2 && has_skin(surface))
        labels = labels_of_joints(model, surface);
    if (labels.names.empty()) fail(name, "has no materials or joints that could be labels of its faces");
    return labels;
}

}  // namespace exemplar::label_files
