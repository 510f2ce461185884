#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::glb_of;
using mesh_files::json_text;
using mesh_files::read_as;
using mesh_files::tetrahedron_gltf;
using mesh_files::tetrahedron_indices;
using mesh_files::tetrahedron_positions;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using V = std::vector<Vec3>;

std::string tetrahedron_glb(const std::string& nodes = "[{'mesh':0}]") {
    return glb_of(tetrahedron_gltf("", nodes), tetrahedron_positions() + tetrahedron_indices());
}

double signed_volume(const TriangleMesh& mesh) {
    double six = 0;
    for (const Face& f : mesh.faces)
        six += mesh.vertices[f[0]].cast<double>().dot(
            mesh.vertices[f[1]].cast<double>().cross(mesh.vertices[f[2]].cast<double>()));
    return six / 6;
}

void expect_tetrahedron(const MeshFile& file) {
    EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
    EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 2, 1}, Face{0, 1, 3}, Face{0, 3, 2}, Face{1, 2, 3}));
    EXPECT_FALSE(file.labels.has_value());
    EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(ReadGltf, BinaryChunkDataUriAndFileBesideIt) {
    expect_tetrahedron(read_as("a.glb", tetrahedron_glb()));
    for (const auto& sample : mesh_files::samples())
        if (sample.file_name == "embedded.gltf") expect_tetrahedron(read_as("a.gltf", sample.bytes));

    const mesh_files::TemporaryFolder folder;
    mesh_files::write_bytes(folder / "my buffer.bin", tetrahedron_positions() + tetrahedron_indices());
    mesh_files::write_bytes(folder / "a.gltf", tetrahedron_gltf("'uri':'my%20buffer.bin',"));
    expect_tetrahedron(read_mesh(folder / "a.gltf"));
}

TEST(ReadGltf, DataUrisOfAnyMediaTypeAndEncoding) {
    const std::string base64 =
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAAADAAIAAQACAAMA";
    for (const std::string head : {"data:;base64,", "data:application/octet-stream;charset=utf-8;base64,",
                                   "data:binary/octet-stream;base64,", "data:application/gltf-buffer;base64,"}) {
        const std::string uri = fmt::format("'uri':'{}{}',", head, base64);
        std::string json = tetrahedron_gltf(uri);
        expect_tetrahedron(read_as("a.gltf", json));
        json.insert(json.rfind("]}"), json_text(",{" + uri + "'byteLength':72}"));  // the same for the indices
        const std::string view = json_text("{'buffer':0,'byteOffset':48");
        json.replace(json.find(view), view.size(), json_text("{'buffer':1,'byteOffset':48"));
        expect_tetrahedron(read_as("a.gltf", json));
    }
    std::string escaped;  // percent-encoded in place of base64
    const std::string bytes = tetrahedron_positions() + tetrahedron_indices();
    for (const char byte : bytes) escaped += fmt::format("%{:02X}", static_cast<unsigned char>(byte));
    expect_tetrahedron(read_as("a.gltf", tetrahedron_gltf("'uri':'data:," + escaped + "',")));
}

TEST(ReadGltf, APlusInTheNameOfABufferIsAPlus) {
    const mesh_files::TemporaryFolder folder;
    mesh_files::write_bytes(folder / "robot+arm.bin", tetrahedron_positions() + tetrahedron_indices());
    for (const std::string name : {"robot+arm.bin", "robot%2Barm.bin"}) {
        mesh_files::write_bytes(folder / "a.gltf", tetrahedron_gltf("'uri':'" + name + "',"));
        expect_tetrahedron(read_mesh(folder / "a.gltf"));
    }
}

TEST(ReadGltf, ElementsWithoutBufferViewAreZeros) {
    std::string json = tetrahedron_gltf("");
    json.replace(json.find("\"bufferView\":0,"), 15, "");
    const TriangleMesh mesh = read_as("a.glb", glb_of(json, tetrahedron_positions() + tetrahedron_indices())).mesh;
    EXPECT_EQ(mesh.vertices, (V{{0, 0, 0}}));
    EXPECT_THAT(mesh.faces, SizeIs(4));
}

TEST(ReadGltf, ManyNodesMayShareAMesh) {
    // Of a mesh of a thousand triangles, in 500 places; the file has 42 kB.
    constexpr int k_triangles = 1000, k_nodes = 500;
    std::string binary, nodes, roots;
    for (int i = 0; i < 3 * k_triangles; ++i)
        for (const float x : {float(i), float(i % 3 == 1), float(i % 3 == 2)}) binary += bytes_of(x);
    for (int i = 0; i < k_nodes; ++i) {
        nodes += fmt::format("{}{{'mesh':0,'translation':[0,0,{}]}}", i ? "," : "", 5 * i);
        roots += fmt::format("{}{}", i ? "," : "", i);
    }
    const std::string json = json_text(
        "{'asset':{'version':'2.0'},'scenes':[{'nodes':[" + roots + "]}],'nodes':[" + nodes +
        "],'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'accessors':[{'bufferView':0,'componentType':5126,"
        "'count':3000,'type':'VEC3'}],'bufferViews':[{'buffer':0,'byteLength':36000}],'buffers':[{'byteLength':36000}]"
        "}");
    const TriangleMesh mesh = read_as("a.glb", glb_of(json, binary)).mesh;
    EXPECT_THAT(mesh.faces, SizeIs(k_triangles * k_nodes));
    EXPECT_THAT(mesh.vertices, SizeIs(3 * k_triangles * k_nodes));
    EXPECT_EQ(mesh.vertices.back(), Vec3(2999, 0, 5 * 499 + 1));
}

TEST(ReadGltf, ExtensionNeedNotMatchTheContainer) {
    expect_tetrahedron(read_as("a.gltf", tetrahedron_glb()));
}

TEST(ReadGltf, TransformsOfNestedNodesApply) {
    // A quarter turn about z, then a shift along x; the child doubles its size first.
    const MeshFile file =
        read_as("a.glb",
                tetrahedron_glb("[{'children':[1],'rotation':[0,0,0.70710678118,0.70710678118],'translation':[10,0,0]},"
                                "{'mesh':0,'scale':[2,2,2]}]"));
    const V expected{{10, 0, 0}, {10, 2, 0}, {8, 0, 0}, {10, 0, 2}};
    ASSERT_THAT(file.mesh.vertices, SizeIs(4));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((file.mesh.vertices[i] - expected[i]).norm(), 1e-5f) << i;
}

TEST(ReadGltf, MatricesAreColumnMajorAndMirrorsTurnFacesAround) {
    const MeshFile shifted =
        read_as("a.glb", tetrahedron_glb("[{'mesh':0,'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1]}]"));
    EXPECT_EQ(shifted.mesh.vertices[0], Vec3(5, 6, 7));
    const double volume = signed_volume(read_as("a.glb", tetrahedron_glb()).mesh);
    EXPECT_NEAR(volume, 1.0 / 6, 1e-6);
    EXPECT_NEAR(signed_volume(read_as("a.glb", tetrahedron_glb("[{'mesh':0,'scale':[-1,1,1]}]")).mesh), volume, 1e-6);
}

TEST(ReadGltf, OnlyTheDefaultSceneIsRead) {
    std::string json = tetrahedron_gltf("", "[{'mesh':0},{'mesh':0,'translation':[5,0,0]}]");
    json.replace(json.find("\"scene\":0"), 9, "\"scene\":1");
    json.replace(json.find("[{\"nodes\":[0]}]"), 15, "[{\"nodes\":[0]},{\"nodes\":[1]}]");
    const MeshFile file = read_as("a.glb", glb_of(json, tetrahedron_positions() + tetrahedron_indices()));
    EXPECT_EQ(file.mesh.vertices[0], Vec3(5, 0, 0));
    EXPECT_THAT(file.mesh.faces, SizeIs(4));
}

TEST(ReadGltf, TwoNodesOfOneMeshAreWeldedWhereTheyMeet) {
    std::string json = tetrahedron_gltf("", "[{'children':[1,2]},{'mesh':0},{'mesh':0,'scale':[-1,1,1]}]");
    const MeshFile file = read_as("a.glb", glb_of(json, tetrahedron_positions() + tetrahedron_indices()));
    EXPECT_THAT(file.mesh.vertices, SizeIs(5));
    EXPECT_THAT(file.mesh.faces, SizeIs(8));
}

/// Five points in a zigzag as one primitive of the given mode, without indices unless `indices` holds some.
MeshFile read_mode(int mode, const std::vector<std::uint8_t>& indices = {}) {
    std::string binary;
    for (float x : {0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 2.f, 0.f, 0.f}) binary += bytes_of(x);
    for (std::uint8_t i : indices) binary += bytes_of(i);
    const std::string with_indices =
        indices.empty()
            ? ""
            : ",{'bufferView':1,'componentType':5121,'count':" + std::to_string(indices.size()) + ",'type':'SCALAR'}";
    const std::string json =
        "{'asset':{'version':'2.0'},'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'mode':" + std::to_string(mode) +
        ",'attributes':{'POSITION':0}" + (indices.empty() ? "" : ",'indices':1") +
        "}]}],'accessors':[{'bufferView':0,'componentType':5126,'count':5,'type':'VEC3'}" + with_indices +
        "],'bufferViews':[{'buffer':0,'byteLength':60},{'buffer':0,'byteOffset':60,'byteLength':" +
        std::to_string(std::max<std::size_t>(indices.size(), 1)) +
        "}],'buffers':[{'byteLength':" + std::to_string((binary.size() + 3) / 4 * 4) + "}]}";
    return read_as("a.glb", glb_of(json_text(json), binary + std::string(4, '\0')));
}

TEST(ReadGltf, StripsAndFansKeepOrientation) {
    EXPECT_THAT(read_mode(5).mesh.faces, ElementsAre(Face{0, 1, 2}, Face{1, 3, 2}, Face{2, 3, 4}));
    EXPECT_THAT(read_mode(6).mesh.faces, ElementsAre(Face{1, 2, 0}, Face{2, 3, 0}, Face{3, 4, 0}));
    // The triangles of no area that join two strips disappear, but count for the alternation.
    EXPECT_THAT(read_mode(5, {0, 1, 2, 2, 3, 3, 2, 4}).mesh.faces, ElementsAre(Face{0, 1, 2}, Face{3, 4, 2}));
    EXPECT_THAT(read_mode(4, {0, 2, 1, 3, 1, 2}).mesh.faces, ElementsAre(Face{0, 2, 1}, Face{3, 1, 2}));
}

TEST(ReadGltf, PointsAndLinesAreLeftOutWithARemark) {
    for (int mode : {0, 1, 2, 3}) {
        const MeshFile file = read_mode(mode);
        EXPECT_THAT(file.mesh.faces, IsEmpty());
        ASSERT_THAT(file.warnings, SizeIs(1));
        EXPECT_THAT(file.warnings[0], HasSubstr("points or lines"));
    }
}

TEST(ReadGltf, InterleavedPositionsUseTheirStride) {
    std::string binary;
    for (int v = 0; v < 3; ++v)
        for (float x : {float(v == 1), float(v == 2), 0.f, 9.f, 9.f}) binary += bytes_of(x);
    const std::string json = json_text(
        "{'asset':{'version':'2.0'},'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3'}],"
        "'bufferViews':[{'buffer':0,'byteLength':60,'byteStride':20}],'buffers':[{'byteLength':60}]}");
    EXPECT_EQ(read_as("a.glb", glb_of(json, binary)).mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(ReadGltf, SparseAccessorsReplaceElements) {
    // The last corner moves; and, without a buffer view, all other corners are at the origin.
    std::string binary = tetrahedron_positions() + tetrahedron_indices();
    binary += bytes_of(std::uint16_t{3}) + bytes_of(std::uint16_t{0});
    for (float x : {7.f, 8.f, 9.f}) binary += bytes_of(x);
    std::string json = tetrahedron_gltf("");
    const auto replace = [&](const std::string& from, const std::string& to) {
        ASSERT_NE(json.find(json_text(from)), std::string::npos) << from;
        json.replace(json.find(json_text(from)), from.size(), json_text(to));
    };
    replace("'byteLength':24}",
            "'byteLength':24},{'buffer':0,'byteOffset':72,'byteLength':2},"
            "{'buffer':0,'byteOffset':76,'byteLength':12}");
    replace("'byteLength':72}", "'byteLength':88}");
    replace("'count':4",
            "'count':4,'sparse':{'count':1,'indices':{'bufferView':2,'componentType':5123},"
            "'values':{'bufferView':3}}");
    EXPECT_EQ(read_as("a.glb", glb_of(json, binary)).mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 8, 9}}));
    replace("'bufferView':0,", "");
    const TriangleMesh welded = read_as("a.glb", glb_of(json, binary)).mesh;
    EXPECT_EQ(welded.vertices, (V{{0, 0, 0}, {7, 8, 9}}));
    EXPECT_THAT(welded.faces, ElementsAre(Face{0, 0, 0}, Face{0, 0, 1}, Face{0, 1, 0}, Face{0, 0, 1}));
}

TEST(ReadGltf, SeveralPrimitivesShareOneMeshAndPlacelessOnesAreLeftOut) {
    std::string json = tetrahedron_gltf("");
    const std::string primitive = json_text("{'attributes':{'POSITION':0},'indices':1}");
    json.replace(json.find(primitive), primitive.size(),
                 primitive + json_text(",{'attributes':{'NORMAL':0}},") + primitive);
    const MeshFile file = read_as("a.glb", glb_of(json, tetrahedron_positions() + tetrahedron_indices()));
    EXPECT_THAT(file.mesh.vertices, SizeIs(4));
    EXPECT_THAT(file.mesh.faces, SizeIs(8));
    EXPECT_EQ(file.mesh.source_face_count, 8u);
    EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("1 primitives without POSITION")));
}

TEST(ReadGltf, RotationsNeedNotBeUnit) {
    const MeshFile file = read_as("a.glb", tetrahedron_glb("[{'mesh':0,'rotation':[0,0,3,3]}]"));
    EXPECT_LT((file.mesh.vertices[1] - Vec3(0, 1, 0)).norm(), 1e-6f);
}

TEST(ReadGltf, ImagesExtrasAndOptionalExtensionsDoNotMatter) {
    std::string json = tetrahedron_gltf("");
    json.insert(
        1, json_text("'images':[{'bufferView':99,'mimeType':'image/png'},{'uri':'none.png'}],'textures':[{'source':7}],"
                     "'extras':{'a':[[[[1]]]]},'extensionsUsed':['KHR_materials_unlit'],"
                     "'extensionsRequired':['KHR_materials_unlit'],'materials':[{'name':'steel'}],"));
    expect_tetrahedron(read_as("a.glb", glb_of(json, tetrahedron_positions() + tetrahedron_indices())));
}

}  // namespace
}  // namespace exemplar
