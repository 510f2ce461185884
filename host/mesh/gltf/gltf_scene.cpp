// Reads the triangles of a glTF scene.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include "host/mesh/editing/weld.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/gltf/gltf_reader.h"
#include "host/mesh/gltf/gltf_surface.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

/// Returns a label per named material, in the order of the materials, and the label of each face.
FaceLabels labels_of_materials(const GltfReader& gltf, const std::vector<int>& materials) {
    FaceLabels labels;
    std::vector<std::int32_t> label_of_material;
    for (const tinygltf::Material& material : gltf.model().materials) {
        if (!material.name.empty() && !is_label_name(material.name))
            gltf.fail("no label can have the name " + quote(material.name) + "; rename that material");
        label_of_material.push_back(material.name.empty() ? -1 : static_cast<std::int32_t>(labels.names.size()));
        if (!material.name.empty()) labels.names.push_back(material.name);
    }
    for (const int material : materials) {
        const bool exists = material >= 0 && static_cast<std::size_t>(material) < label_of_material.size();
        labels.label.push_back(exists ? label_of_material[static_cast<std::size_t>(material)] : -1);
    }
    return labels;
}

}  // namespace

/// Reads all triangles of the default scene into one mesh, as viewers show it at rest, vertices welded by exact
/// position. Material names become labels if Exemplar wrote the file.
MeshFile read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder) {
    const tinygltf::Model model = load_gltf(content, name, folder, GltfContent::still);
    GltfReader gltf(model, name);
    GltfSurface surface = read_gltf_surface(gltf, name);
    MeshFile file;
    file.warnings = std::move(surface.warnings);
    VertexWelder welder;
    std::vector<std::uint32_t> vertex;
    for (const Vec3& position : vertices_at_rest(surface)) vertex.push_back(welder.add(position, file.mesh.vertices));
    file.mesh.faces = std::move(surface.faces);
    for (Face& face : file.mesh.faces)
        for (std::uint32_t& corner : face) corner = vertex[corner];
    file.mesh.source_face_count = static_cast<std::uint32_t>(file.mesh.face_count());
    if (model.asset.generator.starts_with("Exemplar")) file.labels = labels_of_materials(gltf, surface.materials);
    return file;
}

}  // namespace exemplar::mesh_io
