// Works on the JSON of the file; the triangles of its primitives come from the checked reader.
#include "host/mesh/gltf/gltf_split.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <map>
#include <set>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/gltf/gltf_document.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/gltf/gltf_reader.h"
#include "host/mesh/gltf/gltf_surface.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {
namespace mesh_io {
namespace {

using Json = nlohmann::json;
/// Per part the triangles of each primitive that has some.
using PartTriangles = std::map<std::uint32_t, std::map<std::size_t, std::vector<Face>>>;

class GltfSplitter {
  public:
    GltfSplitter(GltfReader& gltf, GltfDocument document, std::span<const std::uint32_t> part_of_face,
                 std::span<const std::string> part_names, const std::string& name)
        : gltf_(gltf), document_(std::move(document)), part_(part_of_face), names_(part_names), name_(name) {}

    /// Divides all nodes of the scene that have triangles, in the order in which read_gltf_surface reads them.
    void split() {
        const GltfTree tree = read_gltf_tree(gltf_);
        std::map<std::uint32_t, PartTriangles> nodes;
        for (const std::uint32_t node : tree.order)
            if (tree.in_scene[node] && gltf_.model().nodes[node].mesh >= 0) nodes[node] = triangles_of_node(node);
        if (next_face_ != part_.size())
            throw UsageError(fmt::format("{} part numbers for {} triangles", part_.size(), next_face_));
        std::vector<std::size_t> uses(names_.size(), 0);
        for (const auto& [node, parts] : nodes)
            for (const auto& [part, primitives] : parts) ++uses[part];
        for (const auto& [node, parts] : nodes)
            if (!parts.empty()) divide_node(node, parts, uses);
        copy_weight_channels();
        drop_unused_meshes();
    }

    std::string bytes(const std::filesystem::path& folder, std::vector<std::string>& warnings) {
        return binary_of_document(std::move(document_), index_bytes_, name_, folder, warnings);
    }

  private:
    PartTriangles triangles_of_node(std::uint32_t node_index) {
        const tinygltf::Node& node = gltf_.model().nodes[node_index];
        if (node.extensions.contains("EXT_mesh_gpu_instancing"))
            gltf_.fail(
                fmt::format("node {} has copies of its mesh (EXT_mesh_gpu_instancing), which share one mesh; "
                            "export it without, or write the parts in another format",
                            node_index));
        PartTriangles parts;
        const tinygltf::Mesh& mesh = gltf_.item(gltf_.model().meshes, node.mesh, "mesh");
        for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
            const auto position = mesh.primitives[p].attributes.find("POSITION");
            if (!GltfReader::has_triangles(mesh.primitives[p]) || position == mesh.primitives[p].attributes.end())
                continue;
            const std::size_t vertices = gltf_.item(gltf_.model().accessors, position->second, "accessor").count;
            for (const Face& face : gltf_.triangles(mesh.primitives[p], vertices)) {
                if (next_face_ >= part_.size() || part_[next_face_] >= names_.size())
                    throw UsageError(fmt::format("triangle {} has no part", next_face_));
                parts[part_[next_face_++]][p].push_back(face);
            }
        }
        return parts;
    }

    void divide_node(std::uint32_t index, const PartTriangles& parts, const std::vector<std::size_t>& uses) {
        Json node = document_.json.at("nodes").at(index);
        const Json mesh = document_.json.at("meshes").at(node.at("mesh").get<std::size_t>());
        std::vector<std::size_t>& children = children_[index];
        for (const auto& [part, primitives] : parts) {
            Json child{{"name", names_[part]}, {"mesh", add_mesh(mesh, primitives, names_[part])}};
            if (uses[part] > 1) child["name"] = fmt::format("{}_{}", names_[part], name_of_node(node, index));
            for (const char* key : {"skin", "weights"})
                if (node.contains(key)) child[key] = node[key];
            children.push_back(document_.json["nodes"].size());
            document_.json["nodes"].push_back(std::move(child));
        }
        keep_the_rest(node, mesh, parts);
        if (!node.contains("children")) node["children"] = Json::array();
        for (const std::size_t child : children) node["children"].push_back(child);
        document_.json["nodes"][index] = std::move(node);
    }

    static std::string name_of_node(const Json& node, std::uint32_t index) {
        const auto name = node.find("name");
        return name != node.end() && name->is_string() ? name->get<std::string>() : std::to_string(index);
    }

    /// Takes the mesh from the node, but for primitives of points and lines.
    void keep_the_rest(Json& node, const Json& mesh, const PartTriangles& parts) {
        std::set<std::size_t> divided;
        for (const auto& [part, primitives] : parts)
            for (const auto& [p, faces] : primitives) divided.insert(p);
        Json rest = mesh;
        rest["primitives"] = Json::array();
        for (std::size_t p = 0; p < mesh.at("primitives").size(); ++p)
            if (!divided.contains(p)) rest["primitives"].push_back(mesh["primitives"][p]);
        if (!rest["primitives"].empty()) {
            node["mesh"] = document_.json["meshes"].size();
            document_.json["meshes"].push_back(std::move(rest));
            return;
        }
        for (const char* key : {"mesh", "skin", "weights"}) node.erase(key);
    }

    std::size_t add_mesh(const Json& mesh, const std::map<std::size_t, std::vector<Face>>& primitives,
                         const std::string& name) {
        Json part = mesh;
        part["name"] = name;
        part["primitives"] = Json::array();
        for (const auto& [p, faces] : primitives) {
            Json primitive = mesh.at("primitives").at(p);
            primitive.erase("mode");
            primitive["indices"] = add_indices(faces);
            part["primitives"].push_back(std::move(primitive));
        }
        document_.json["meshes"].push_back(std::move(part));
        return document_.json["meshes"].size() - 1;
    }

    std::size_t add_indices(const std::vector<Face>& faces) {
        constexpr int k_unsigned_short = 5123, k_unsigned_int = 5125;
        constexpr std::uint32_t k_restart = 0xffff;  // no index of two bytes
        std::uint32_t largest = 0;
        for (const Face& face : faces) largest = std::max({largest, face[0], face[1], face[2]});
        const bool is_short = largest < k_restart;
        std::string bytes;
        bytes.reserve(faces.size() * (is_short ? 6 : 12));
        for (const Face& face : faces)
            for (const std::uint32_t corner : face)
                if (is_short)
                    append_bytes(bytes, static_cast<std::uint16_t>(corner));
                else
                    append_bytes(bytes, corner);
        Json& accessors = document_.json["accessors"];
        accessors.push_back({{"bufferView", document_.json["bufferViews"].size() + index_bytes_.size()},
                             {"componentType", is_short ? k_unsigned_short : k_unsigned_int},
                             {"count", 3 * faces.size()},
                             {"type", "SCALAR"}});
        index_bytes_.push_back(std::move(bytes));
        return accessors.size() - 1;
    }

    /// Lets animations of the weights of a divided node move its children.
    void copy_weight_channels() {
        if (!document_.json.contains("animations")) return;
        for (Json& animation : document_.json["animations"]) {
            Json channels = Json::array();
            for (const Json& channel : animation.at("channels")) {
                const Json& target = channel.at("target");
                const auto node = target.contains("node") && target.value("path", "") == "weights"
                                      ? children_.find(target["node"].get<std::uint32_t>())
                                      : children_.end();
                if (node == children_.end()) {
                    channels.push_back(channel);
                    continue;
                }
                for (const std::size_t child : node->second) {
                    channels.push_back(channel);
                    channels.back()["target"]["node"] = child;
                }
            }
            animation["channels"] = std::move(channels);
        }
    }

    void drop_unused_meshes() {
        Json kept = Json::array();
        std::map<std::size_t, std::size_t> number;
        for (Json& node : document_.json["nodes"]) {
            if (!node.contains("mesh")) continue;
            const auto mesh = node["mesh"].get<std::size_t>();
            const auto [it, is_new] = number.try_emplace(mesh, kept.size());
            if (is_new) kept.push_back(document_.json["meshes"].at(mesh));
            node["mesh"] = it->second;
        }
        document_.json["meshes"] = std::move(kept);
    }

    GltfReader& gltf_;
    GltfDocument document_;
    std::span<const std::uint32_t> part_;
    std::span<const std::string> names_;
    const std::string& name_;
    std::size_t next_face_ = 0;
    std::vector<std::string> index_bytes_;                        ///< of new buffer views
    std::map<std::uint32_t, std::vector<std::size_t>> children_;  ///< of divided nodes, the nodes of their parts
};

}  // namespace
}  // namespace mesh_io

SplitGltf split_gltf(const std::filesystem::path& path, std::span<const std::uint32_t> part_of_face,
                     std::span<const std::string> part_names) {
    const std::string content = read_file(path), name = path.string();
    const std::filesystem::path folder = path.parent_path();
    const tinygltf::Model model = mesh_io::load_gltf(content, name, folder, mesh_io::GltfContent::still);
    mesh_io::GltfReader reader(model, name);
    SplitGltf split;
    try {
        mesh_io::GltfSplitter splitter(reader, mesh_io::read_gltf_document(content, name, folder), part_of_face,
                                       part_names, name);
        splitter.split();
        split.bytes = splitter.bytes(folder, split.warnings);
    } catch (const nlohmann::json::exception&) {
        mesh_io::fail(name, "its JSON has a value of the wrong type; export it again");
    }
    return split;
}

bool is_gltf_file(const std::filesystem::path& path) {
    const std::string extension = lower_case(path.extension().string());
    return extension == ".gltf" || extension == ".glb";
}

}  // namespace exemplar
