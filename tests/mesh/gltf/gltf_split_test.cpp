#include "host/mesh/gltf/gltf_split.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::error_of;
using mesh_files::glb_of;
using mesh_files::json_text;
using mesh_files::read_as;
using mesh_files::write_bytes;
using PlainJson = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// A tetrahedron with UVs, a morph target and a material, and a line; on two nodes, of which one is animated.
std::string textured_glb() {
    std::string binary = mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices();  // 48 + 24 bytes
    for (int i = 0; i < 8; ++i) binary += bytes_of(0.125F * static_cast<float>(i));                // UVs: 32 bytes
    binary += bytes_of(0.0F) + bytes_of(1.0F);                                                     // times: 8 bytes
    binary += bytes_of(0.0F) + bytes_of(1.0F);                                                     // weights: 8 bytes
    binary += "\x89PNG picture";                                                                   // 12 bytes
    return glb_of(
        json_text("{'asset':{'version':'2.0'},'scenes':[{'nodes':[0,1]}],'nodes':[{'name':'first','mesh':0,"
                  "'translation':[0,0,5],'weights':[0.25],'extras':{'kept':7}},{'mesh':0,'scale':[-1,1,1]},{'mesh':1}],"
                  "'meshes':[{'extras':{'targetNames':['smile']},'primitives':[{'attributes':{'POSITION':0,"
                  "'TEXCOORD_0':2},'indices':1,'material':0,'targets':[{'POSITION':0}]},{'attributes':{'POSITION':0},"
                  "'mode':1,'targets':[{'POSITION':0}]}]},{'primitives':[{'attributes':{'POSITION':0}}]}],"
                  "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],'textures':[{'source':0}],"
                  "'images':[{'bufferView':5,'mimeType':'image/png'}],"
                  "'animations':[{'channels':[{'sampler':0,'target':{'node':0,'path':'weights'}},{'sampler':0,"
                  "'target':{'node':0,'path':'translation'}}],'samplers':[{'input':3,'output':4}]}],"
                  "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
                  "{'bufferView':1,'componentType':5123,'count':12,'type':'SCALAR'},"
                  "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC2'},"
                  "{'bufferView':3,'componentType':5126,'count':2,'type':'SCALAR'},"
                  "{'bufferView':4,'componentType':5126,'count':2,'type':'SCALAR'}],"
                  "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':24},"
                  "{'buffer':0,'byteOffset':72,'byteLength':32},{'buffer':0,'byteOffset':104,'byteLength':8},"
                  "{'buffer':0,'byteOffset':112,'byteLength':8},{'buffer':0,'byteOffset':120,'byteLength':12}],"
                  "'buffers':[{'byteLength':132}]}"),
        binary);
}

struct Chunks {
    PlainJson document;
    std::string binary;
};
Chunks chunks_of(const std::string& glb) {
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, glb.data() + 12, 4);
    return {PlainJson::parse(glb.substr(20, bytes)), glb.substr(28 + bytes)};
}
std::string view_bytes(const Chunks& chunks, std::size_t view) {
    const PlainJson& v = chunks.document["bufferViews"][view];
    return chunks.binary.substr(v.value("byteOffset", std::size_t{0}), v["byteLength"].get<std::size_t>());
}

SplitGltf split_bytes(const std::string& file_name, const std::string& bytes, const std::vector<std::uint32_t>& part,
                      const std::vector<std::string>& names) {
    const TemporaryFolder folder;
    write_bytes(folder / file_name, bytes);
    return split_gltf(folder / file_name, part, names);
}

using Corners = std::array<std::array<float, 3>, 3>;
std::multiset<Corners> corner_sets_of(const TriangleMesh& mesh) {
    std::multiset<Corners> triangles;
    for (const Face& face : mesh.faces) {
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) corners[i][k] = mesh.vertices[face[i]][static_cast<Eigen::Index>(k)];
        triangles.insert(corners);
    }
    return triangles;
}

TEST(SplitGltf, EachPartIsANodeAndAllElseStays) {
    const std::string original = textured_glb();
    const std::vector<std::uint32_t> part{0, 0, 1, 1, 1, 1, 1, 1};
    const SplitGltf split = split_bytes("x.glb", original, part, {"head", "body"});
    EXPECT_TRUE(split.warnings.empty());
    const Chunks before = chunks_of(original), after = chunks_of(split.bytes);
    const PlainJson& nodes = after.document["nodes"];
    ASSERT_EQ(nodes.size(), 6u);
    EXPECT_EQ(nodes[0]["name"], "first");
    EXPECT_EQ(nodes[0]["translation"], PlainJson({0, 0, 5}));
    EXPECT_EQ(nodes[0]["extras"]["kept"], 7);
    EXPECT_EQ(nodes[0]["children"], PlainJson({3, 4}));
    EXPECT_EQ(nodes[1]["children"], PlainJson({5}));
    EXPECT_EQ(nodes[3]["name"], "head");
    EXPECT_EQ(nodes[4]["name"], "body_first");
    EXPECT_EQ(nodes[5]["name"], "body_1");
    EXPECT_EQ(nodes[3]["weights"], PlainJson({0.25}));
    const PlainJson& head = after.document["meshes"][nodes[3]["mesh"].get<std::size_t>()];
    EXPECT_EQ(head["name"], "head");
    EXPECT_EQ(head["extras"]["targetNames"], PlainJson({"smile"}));
    ASSERT_EQ(head["primitives"].size(), 1u);
    const PlainJson& kept = before.document["meshes"][0]["primitives"][0];
    for (const char* key : {"attributes", "material", "targets"}) EXPECT_EQ(head["primitives"][0][key], kept[key]);
    const PlainJson& rest = after.document["meshes"][nodes[0]["mesh"].get<std::size_t>()];
    ASSERT_EQ(rest["primitives"].size(), 1u) << "the lines";
    EXPECT_EQ(rest["primitives"][0]["mode"], 1);
    EXPECT_EQ(view_bytes(after, after.document["images"][0]["bufferView"].get<std::size_t>()), "\x89PNG picture");
    for (std::size_t v = 0; v < before.document["bufferViews"].size(); ++v)
        EXPECT_EQ(view_bytes(after, v), view_bytes(before, v));
    EXPECT_EQ(corner_sets_of(read_as("x.glb", split.bytes).mesh), corner_sets_of(read_as("x.glb", original).mesh));
}

TEST(SplitGltf, AnimatedWeightsMoveAllParts) {
    const SplitGltf split = split_bytes("x.glb", textured_glb(), {0, 1, 0, 1, 0, 0, 0, 0}, {"a", "b"});
    std::multimap<std::string, int> targets;
    const Chunks chunks = chunks_of(split.bytes);
    for (const PlainJson& channel : chunks.document["animations"][0]["channels"])
        targets.emplace(channel["target"]["path"], channel["target"]["node"]);
    EXPECT_THAT(targets,
                UnorderedElementsAre(std::pair("weights", 3), std::pair("weights", 4), std::pair("translation", 0)));
}

TEST(SplitGltf, BuffersAndImagesBesideTheFileAreEmbedded) {
    const TemporaryFolder folder;
    std::string text = mesh_files::tetrahedron_gltf("'uri':'x.bin',");
    text.insert(text.size() - 1, json_text(",'images':[{'uri':'a%20b.png'},{'uri':'missing.png'}]"));
    write_bytes(folder / "x.gltf", text);
    write_bytes(folder / "x.bin", mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices());
    write_bytes(folder / "a b.png", "\x89PNG here");
    const std::vector<std::string> names{"a", "b"};
    const SplitGltf split = split_gltf(folder / "x.gltf", std::vector<std::uint32_t>{0, 1, 1, 0}, names);
    const Chunks chunks = chunks_of(split.bytes);
    const PlainJson& image = chunks.document["images"][0];
    EXPECT_EQ(view_bytes(chunks, image["bufferView"].get<std::size_t>()), "\x89PNG here");
    EXPECT_EQ(image["mimeType"], "image/png");
    EXPECT_FALSE(image.contains("uri"));
    EXPECT_EQ(chunks.document["images"][1]["uri"], "missing.png");
    EXPECT_THAT(split.warnings, ElementsAre(HasSubstr("missing.png")));
    EXPECT_FALSE(chunks.document["buffers"][0].contains("uri"));
    EXPECT_EQ(corner_sets_of(read_as("x.glb", split.bytes).mesh), corner_sets_of(read_mesh(folder / "x.gltf").mesh));
}

TEST(SplitGltf, RefusesWhatDoesNotFit) {
    const std::string glb = textured_glb();
    error_of<UsageError>([&] { split_bytes("x.glb", glb, {0, 0, 0}, {"a"}); });
    error_of<UsageError>([&] { split_bytes("x.glb", glb, {0, 0, 0, 0, 0, 0, 0, 0, 0}, {"a"}); });
    error_of<UsageError>([&] { split_bytes("x.glb", glb, {0, 0, 0, 0, 0, 0, 0, 1}, {"a"}); });
    const std::string copies = glb_of(
        mesh_files::tetrahedron_gltf("", "[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{}}}}]"),
        mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices());
    EXPECT_THAT(error_of<MeshError>([&] {
                    split_bytes("x.glb", copies, {0, 0, 0, 0}, {"a"});
                }),
                HasSubstr("EXT_mesh_gpu_instancing"));
}

}  // namespace
}  // namespace exemplar
