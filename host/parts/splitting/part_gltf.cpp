// Writes parts as binary glTF: a node, a mesh and a material per part, each with its own accessors.
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/io/io_write_text.h"
#include "host/parts/splitting/part_files.h"

namespace exemplar {
namespace {

using PartJson = nlohmann::ordered_json;

PartJson material_of_part(const std::string& name, std::int32_t label) {
    const Color color = label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label));
    const std::array<double, 3> linear = linear_color(color);
    return {{"name", name},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {linear[0], linear[1], linear[2], 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 1.0}}}};
}

/// The document and its binary chunk, part after part.
class PartDocument {
  public:
    PartDocument() {
        for (const char* key : {"nodes", "meshes", "materials", "accessors", "bufferViews"})
            document_[key] = PartJson::array();
        document_["asset"] = {{"version", "2.0"}, {"generator", "Exemplar"}};
    }

    void add(const std::string& name, std::int32_t label, const TriangleMesh& mesh) {
        const std::size_t number = document_["nodes"].size();
        PartJson node{{"name", name}, {"mesh", number}};
        if (mesh.origin != Vec3d::Zero()) node["translation"] = {mesh.origin[0], mesh.origin[1], mesh.origin[2]};
        const std::size_t positions = add_positions(mesh), indices = add_indices(mesh);
        document_["nodes"].push_back(node);
        document_["materials"].push_back(material_of_part(name, label));
        document_["meshes"].push_back(
            {{"name", name},
             {"primitives",
              {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", number}}}}});
        scene_.push_back(number);
    }

    std::string bytes() {
        document_["scene"] = 0;
        document_["scenes"] = {{{"nodes", scene_}}};
        document_["buffers"] = {{{"byteLength", binary_.size()}}};
        return mesh_io::binary_gltf(ordered_json_text(document_), binary_);
    }

  private:
    std::size_t add_view(std::size_t begin, int target) {
        document_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}, {"target", target}});
        return document_["bufferViews"].size() - 1;
    }
    std::size_t add_positions(const TriangleMesh& mesh) {
        constexpr int k_float = 5126, k_array_buffer = 34962;
        const std::size_t begin = binary_.size();
        Vec3 low = mesh.vertices.front(), high = low;
        for (const Vec3& p : mesh.vertices) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
            for (int i = 0; i < 3; ++i) mesh_io::append_bytes(binary_, p[i]);
        }
        document_["accessors"].push_back({{"bufferView", add_view(begin, k_array_buffer)},
                                          {"componentType", k_float},
                                          {"count", mesh.vertex_count()},
                                          {"type", "VEC3"},
                                          {"min", {low[0], low[1], low[2]}},
                                          {"max", {high[0], high[1], high[2]}}});
        return document_["accessors"].size() - 1;
    }
    std::size_t add_indices(const TriangleMesh& mesh) {
        constexpr int k_uint32 = 5125, k_element_array_buffer = 34963;
        const std::size_t begin = binary_.size();
        for (const Face& face : mesh.faces)
            for (const std::uint32_t corner : face) mesh_io::append_bytes(binary_, corner);
        document_["accessors"].push_back({{"bufferView", add_view(begin, k_element_array_buffer)},
                                          {"componentType", k_uint32},
                                          {"count", 3 * mesh.face_count()},
                                          {"type", "SCALAR"}});
        return document_["accessors"].size() - 1;
    }

    PartJson document_, scene_ = PartJson::array();
    std::string binary_;
};

}  // namespace

void write_parts_gltf(const std::filesystem::path& path, const MeshParts& names, std::span<const PartMesh> parts) {
    PartDocument document;
    for (std::size_t p = 0; p < parts.size(); ++p)
        if (!parts[p].mesh.faces.empty()) document.add(names.names[p], names.labels[p], parts[p].mesh);
    const std::string bytes = document.bytes();
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
