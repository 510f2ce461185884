// Writes binary glTF 2.0 with materials: per label a primitive with its own vertices, which are divided at seams.
#include "host/parts/materials/write_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/core/json_text.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/parts/materials/part_projection.h"

namespace exemplar {
namespace {

using MaterialJson = nlohmann::ordered_json;

/// The vertices and triangles of one label.
struct LabelSurface {
    std::vector<float> positions, normals, uvs;
    std::vector<std::uint32_t> corners;
    std::map<std::tuple<std::uint32_t, std::uint32_t, float>, std::uint32_t> vertex;  ///< by vertex, part and u

    /// Adds a corner; equal vertices of a part with equal coordinates are one.
    void add(const TriangleMesh& mesh, const std::vector<Vec3>& normal, std::uint32_t v, std::uint32_t part,
             const Vec2& uv) {
        const auto [at, is_new] =
            vertex.try_emplace({v, part, uv[0]}, static_cast<std::uint32_t>(positions.size() / 3));
        corners.push_back(at->second);
        if (!is_new) return;
        positions.insert(positions.end(), mesh.vertices[v].data(), mesh.vertices[v].data() + 3);
        normals.insert(normals.end(), normal[v].data(), normal[v].data() + 3);
        uvs.insert(uvs.end(), {uv[0], uv[1]});
    }
};

class MaterialWriter {
  public:
    explicit MaterialWriter(const TriangleMesh& mesh) {
        document_["asset"] = {{"version", "2.0"}, {"generator", "Exemplar"}};
        document_["scene"] = 0;
        document_["scenes"] = {{{"nodes", {0}}}};
        document_["nodes"] = {{{"mesh", 0}}};
        if (!mesh.origin.isZero(0))
            document_["nodes"][0]["translation"] = {mesh.origin[0], mesh.origin[1], mesh.origin[2]};
        for (const char* list : {"materials", "accessors", "bufferViews"}) document_[list] = MaterialJson::array();
    }

    void add(const LabelSurface& surface, const std::string& name, const Color& label_color,
             const PartMaterial& material) {
        MaterialJson attributes;
        attributes["POSITION"] = add_floats(surface.positions, "VEC3", 3, true);
        attributes["NORMAL"] = add_floats(surface.normals, "VEC3", 3, false);
        attributes["TEXCOORD_0"] = add_floats(surface.uvs, "VEC2", 2, false);
        const std::size_t view =
            add_view(surface.corners.data(), surface.corners.size() * sizeof(std::uint32_t), 34963);
        document_["accessors"].push_back(
            {{"bufferView", view}, {"componentType", 5125}, {"count", surface.corners.size()}, {"type", "SCALAR"}});
        document_["meshes"][0]["primitives"].push_back({{"attributes", attributes},
                                                        {"indices", document_["accessors"].size() - 1},
                                                        {"material", document_["materials"].size()}});
        // Made first: it may add entries to the document, which moves all others.
        MaterialJson json = material_json(name, label_color, material);
        document_["materials"].push_back(std::move(json));
    }

    std::string bytes() {
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        document_["buffers"] = {{{"byteLength", binary_.size()}}};
        return mesh_io::binary_gltf(ordered_json_text(document_), binary_);
    }

  private:
    std::size_t add_view(const void* data, std::size_t size, int target) {
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        MaterialJson view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
        if (target != 0) view["target"] = target;
        binary_.append(static_cast<const char*>(data), size);
        document_["bufferViews"].push_back(view);
        return document_["bufferViews"].size() - 1;
    }

    std::size_t add_floats(const std::vector<float>& values, const char* type, std::size_t width, bool bounds) {
        MaterialJson accessor{{"bufferView", add_view(values.data(), values.size() * sizeof(float), 34962)},
                              {"componentType", 5126},
                              {"count", values.size() / width},
                              {"type", type}};
        if (bounds) {
            std::vector<float> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), high = low;
            for (std::size_t i = 0; i < values.size(); ++i) {
                low[i % width] = std::min(low[i % width], values[i]);
                high[i % width] = std::max(high[i % width], values[i]);
            }
            accessor["min"] = low;
            accessor["max"] = high;
        }
        document_["accessors"].push_back(std::move(accessor));
        return document_["accessors"].size() - 1;
    }

    MaterialJson material_json(const std::string& name, const Color& label_color, const PartMaterial& material) {
        const Color color = material.color.value_or(material.texture.empty() ? label_color : Color{255, 255, 255});
        const std::array<double, 3> linear = linear_color(color);
        MaterialJson json;
        if (!name.empty()) json["name"] = name;
        json["doubleSided"] = true;
        json["pbrMetallicRoughness"] = {{"baseColorFactor", {linear[0], linear[1], linear[2], 1.0}},
                                        {"metallicFactor", material.metallic},
                                        {"roughnessFactor", material.roughness}};
        if (!material.texture.empty())
            json["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add_texture(material.texture)}};
        return json;
    }

    /// Embeds an image once, with a sampler that repeats it.
    std::size_t add_texture(const std::filesystem::path& path) {
        const auto [at, is_new] = textures_.try_emplace(path.string(), textures_.size());
        if (!is_new) return at->second;
        const std::string content = read_file(path);
        const bool is_png = content.starts_with("\x89PNG\r\n\x1a\n"), is_jpeg = content.starts_with("\xff\xd8\xff");
        if (!is_png && !is_jpeg)
            throw DataError(path.string() + ": neither PNG nor JPEG, which glTF textures are; convert it");
        const std::size_t view = add_view(content.data(), content.size(), 0);
        document_["images"].push_back({{"bufferView", view}, {"mimeType", is_png ? "image/png" : "image/jpeg"}});
        if (!document_.contains("samplers"))
            document_["samplers"] = {{{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}}};
        document_["textures"].push_back({{"sampler", 0}, {"source", at->second}});
        return at->second;
    }

    MaterialJson document_;
    std::string binary_;
    std::map<std::string, std::size_t> textures_;
};

const PartMaterial& material_of_label(const MaterialTable& materials, const std::string& name) {
    static const PartMaterial plain;
    if (const auto own = materials.find(name); own != materials.end()) return own->second;
    const auto rest = materials.find("*");
    return rest == materials.end() ? plain : rest->second;
}

std::vector<std::vector<std::uint32_t>> faces_of_parts(const PartGraph& graph) {
    std::vector<std::vector<std::uint32_t>> faces(graph.parts.size());
    for (std::uint32_t f = 0; f < graph.part_of_face.size(); ++f) faces[graph.part_of_face[f]].push_back(f);
    return faces;
}

}  // namespace

void write_materials(const std::filesystem::path& path, const TriangleMesh& mesh, const PartGraph& graph,
                     const std::vector<std::string>& names, const MaterialTable& materials) {
    const std::vector<Vec3> normal = vertex_normals(mesh);
    const Vec3 center = area_centroid(mesh);
    const auto diagonal = static_cast<float>(bounding_box(mesh).diagonal());
    const auto faces = faces_of_parts(graph);
    MaterialWriter writer(mesh);
    for (std::int32_t label = -1; label < static_cast<std::int32_t>(names.size()); ++label) {
        const std::string name = label < 0 ? std::string() : names[static_cast<std::size_t>(label)];
        const PartMaterial& material = material_of_label(materials, name);
        LabelSurface surface;
        for (std::uint32_t part = 0; part < graph.parts.size(); ++part) {
            if (graph.parts[part].label != label) continue;
            check_interrupt();
            const std::vector<CornerUv> uv = project_part(mesh, faces[part], center, material.size * diagonal);
            for (std::size_t i = 0; i < uv.size(); ++i)
                for (std::size_t k = 0; k < 3; ++k)
                    surface.add(mesh, normal, mesh.faces[faces[part][i]][k], part, uv[i][k]);
        }
        if (surface.corners.empty()) continue;
        writer.add(surface, name, label < 0 ? k_unlabeled_color : label_color(static_cast<std::size_t>(label)),
                   material);
    }
    const std::string bytes = writer.bytes();
    if (bytes.size() > std::numeric_limits<std::uint32_t>::max() / 2)
        throw MeshError(path.string() + ": the mesh is too large for a glTF file");
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
