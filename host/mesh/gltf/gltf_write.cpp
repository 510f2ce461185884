// Writes binary glTF 2.0: all vertices in one accessor, and for each label that occurs a primitive with its own
// indices.
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr int k_float = 5126, k_uint32 = 5125, k_vertex_target = 34962, k_index_target = 34963;

/// The triangles of one label.
struct Part {
    std::int32_t label;  ///< -1: the unlabeled ones
    std::vector<Face> faces;
};

std::vector<Part> parts_by_label(const TriangleMesh& mesh, const FaceLabels& labels) {
    std::vector<Part> parts(labels.names.size() + 1);
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].label = static_cast<std::int32_t>(i) - 1;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        parts[std::size_t{1} + labels.label[mesh.source_of(f)]].faces.push_back(mesh.faces[f]);
    std::erase_if(parts, [](const Part& part) { return part.faces.empty(); });
    return parts;
}

/// The material of unlabeled faces has no name, which distinguishes it from every label.
OrderedJson material_of(std::int32_t label, const FaceLabels& labels) {
    const Color color = label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label));
    const std::array<double, 3> linear = linear_color(color);
    OrderedJson material;
    if (label >= 0) material["name"] = labels.names[static_cast<std::size_t>(label)];
    material["doubleSided"] = true;
    material["pbrMetallicRoughness"] = {
        {"baseColorFactor", {linear[0], linear[1], linear[2], 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}};
    return material;
}

/// The accessor of all positions; viewers need its exact bounds.
OrderedJson position_accessor(const TriangleMesh& mesh) {
    Vec3 low = mesh.vertices.front(), high = low;
    for (const Vec3& p : mesh.vertices) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return {{"bufferView", 0}, {"componentType", k_float},        {"count", mesh.vertex_count()},
            {"type", "VEC3"},  {"min", {low[0], low[1], low[2]}}, {"max", {high[0], high[1], high[2]}}};
}

OrderedJson document_of(const TriangleMesh& mesh, const FaceLabels& labels, const std::vector<Part>& parts) {
    OrderedJson materials = OrderedJson::array(), primitives = OrderedJson::array(),
                accessors = OrderedJson::array({position_accessor(mesh)});
    std::size_t index_bytes = 0;
    for (const Part& part : parts) {
        primitives.push_back({{"attributes", {{"POSITION", 0}}},
                              {"indices", accessors.size()},
                              {"material", materials.size()},
                              {"mode", 4}});
        materials.push_back(material_of(part.label, labels));
        accessors.push_back({{"bufferView", 1},
                             {"byteOffset", index_bytes},
                             {"componentType", k_uint32},
                             {"count", 3 * part.faces.size()},
                             {"type", "SCALAR"}});
        index_bytes += part.faces.size() * sizeof(Face);
    }
    const std::size_t vertex_bytes = mesh.vertex_count() * sizeof(Vec3);
    OrderedJson document;
    document["asset"] = {{"version", "2.0"}, {"generator", "Exemplar"}};
    document["scene"] = 0;
    document["scenes"] = {{{"nodes", {0}}}};
    document["nodes"] = {{{"mesh", 0}}};
    if (!mesh.origin.isZero(0)) document["nodes"][0]["translation"] = {mesh.origin[0], mesh.origin[1], mesh.origin[2]};
    document["meshes"] = {{{"primitives", primitives}}};
    document["materials"] = materials;
    document["accessors"] = accessors;
    document["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", vertex_bytes}, {"target", k_vertex_target}},
        {{"buffer", 0}, {"byteOffset", vertex_bytes}, {"byteLength", index_bytes}, {"target", k_index_target}}};
    document["buffers"] = {{{"byteLength", vertex_bytes + index_bytes}}};
    return document;
}

void check_writable(const std::filesystem::path& path, const TriangleMesh& mesh) {
    if (mesh.faces.empty()) throw MeshError(path.string() + ": a glTF file cannot hold a mesh without faces");
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        if (!mesh.vertices[v].allFinite())
            throw MeshError(fmt::format("{}: vertex {} is not finite, which glTF cannot say", path.string(), v));
    const std::uint64_t bytes = mesh.vertex_count() * sizeof(Vec3) + mesh.face_count() * sizeof(Face);
    if (bytes > std::numeric_limits<std::uint32_t>::max() / 2)
        throw MeshError(path.string() + ": the mesh is too large for a glTF file; write PLY");
}

}  // namespace

void write_gltf(const std::filesystem::path& path, const TriangleMesh& mesh, const FaceLabels& labels) {
    mesh_io::check_labels(mesh, labels);
    check_writable(path, mesh);
    const std::vector<Part> parts = parts_by_label(mesh, labels);
    std::string json = ordered_json_text(document_of(mesh, labels, parts));
    std::string binary;
    for (const Vec3& p : mesh.vertices)
        for (int i = 0; i < 3; ++i) mesh_io::append_bytes(binary, p[i]);
    for (const Part& part : parts)
        for (const Face& face : part.faces) mesh_io::append_bytes(binary, face);
    const std::string bytes = mesh_io::binary_gltf(std::move(json), binary);
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
