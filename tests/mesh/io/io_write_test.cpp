#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::error_of;
using mesh_files::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two triangles that were one quad and one triangle of three in a file: source faces 0 (the quad) and 2.
TriangleMesh small_mesh() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.1f, -1.5f, 0}, {0, 1e-7f, 2}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}};
    mesh.source_face = {0, 0, 2};
    mesh.source_face_count = 3;
    return mesh;
}
FaceLabels small_labels() {
    return {{"leg", "upper arm", "none has it"}, {1, -1, 0}};
}

std::string floats(const std::vector<float>& values) {
    std::string bytes;
    for (float x : values) bytes += bytes_of(x);
    return bytes;
}
std::string words(const std::vector<std::uint32_t>& values) {
    std::string bytes;
    for (std::uint32_t x : values) bytes += bytes_of(x);
    return bytes;
}

TEST(WriteGolden, Off) {
    const TemporaryFolder folder;
    write_off(folder / "a.off", small_mesh());
    EXPECT_EQ(read_file(folder / "a.off"),
              "OFF\n4 3 0\n0 0 0\n1 0 0\n0.1 -1.5 0\n0 1e-07 2\n3 0 1 2\n3 0 2 3\n3 1 3 2\n");
}

TEST(WriteGolden, Obj) {
    const TemporaryFolder folder;
    write_obj(folder / "a.obj", small_mesh());
    EXPECT_EQ(read_file(folder / "a.obj"), "v 0 0 0\nv 1 0 0\nv 0.1 -1.5 0\nv 0 1e-07 2\nf 1 2 3\nf 1 3 4\nf 2 4 3\n");
}

const std::vector<float> k_positions{0, 0, 0, 1, 0, 0, 0.1f, -1.5f, 0, 0, 1e-7f, 2};

TEST(WriteGolden, PlyWithoutLabels) {
    const TemporaryFolder folder;
    write_ply(folder / "a.ply", small_mesh());
    EXPECT_EQ(
        read_file(folder / "a.ply"),
        "ply\nformat binary_little_endian 1.0\ncomment made by Exemplar\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n" +
            floats(k_positions) + "\3" + words({0, 1, 2}) + "\3" + words({0, 2, 3}) + "\3" + words({1, 3, 2}));
}

TEST(WriteGolden, PlyWithLabelsAndConfidence) {
    const TemporaryFolder folder;
    const FaceLabels labels = small_labels();
    write_ply(folder / "a.ply", small_mesh(), &labels, std::vector<float>{0.5f, 0, 1});
    const std::string quad_rest = words({1}) + "\x40\x78\xc8" + floats({0.5f});  // label 1 is (64, 120, 200)
    EXPECT_EQ(read_file(folder / "a.ply"),
              "ply\nformat binary_little_endian 1.0\ncomment made by Exemplar\ncomment label 0 leg\n"
              "comment label 1 upper arm\ncomment label 2 none has it\nelement vertex 4\nproperty float x\n"
              "property float y\nproperty float z\nelement face 3\nproperty list uchar int vertex_indices\n"
              "property int label\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
              "property float confidence\nend_header\n" +
                  floats(k_positions) + "\3" + words({0, 1, 2}) + quad_rest + "\3" + words({0, 2, 3}) + quad_rest +
                  "\3" + words({1, 3, 2}) + words({0}) + "\xd4\x50\x40" + floats({1}));  // label 0 is (212, 80, 64)
}

TEST(WriteGolden, Gltf) {
    const TemporaryFolder folder;
    write_gltf(folder / "a.glb", small_mesh(), {{"leg", "arm"}, {1, -1, -1}});
    const std::string json = mesh_files::json_text(
        "{'asset':{'version':'2.0','generator':'Exemplar'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'material':0,'mode':4},"
        "{'attributes':{'POSITION':0},'indices':2,'material':1,'mode':4}]}],"
        "'materials':[{'doubleSided':true,'pbrMetallicRoughness':{'baseColorFactor':[0.21586,0.21586,0.21586,1.0],"
        "'metallicFactor':0.0,'roughnessFactor':1.0}},"
        "{'name':'arm','doubleSided':true,'pbrMetallicRoughness':{'baseColorFactor':[0.05127,0.18782,0.57758,1.0],"
        "'metallicFactor':0.0,'roughnessFactor':1.0}}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','min':[0.0,-1.5,0.0],'max':[1.0,"
        "1.0000000116860974e-07,2.0]},"
        "{'bufferView':1,'byteOffset':0,'componentType':5125,'count':3,'type':'SCALAR'},"
        "{'bufferView':1,'byteOffset':12,'componentType':5125,'count':6,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':0,'byteOffset':0,'byteLength':48,'target':34962},"
        "{'buffer':0,'byteOffset':48,'byteLength':36,'target':34963}],'buffers':[{'byteLength':84}]}");
    EXPECT_EQ(read_file(folder / "a.glb"),
              mesh_files::glb_of(json, floats(k_positions) + words({1, 3, 2}) + words({0, 1, 2, 0, 2, 3})));
}

TEST(WriteGolden, LabelsTxtAndSeg) {
    const TemporaryFolder folder;
    write_labels_txt(folder / "a.txt", {{"leg", "unused", "arm"}, {2, 0, 2}});
    EXPECT_EQ(read_file(folder / "a.txt"), "leg\n2\narm\n1 3\n");
    write_seg(folder / "a.seg", small_mesh(), {{"leg", "arm"}, {1, 0, 1}});
    EXPECT_EQ(read_file(folder / "a.seg"), "0\n1\n0\n");
}

TEST(WriteGltf, IsAlignedAndInBounds) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = shapes::icosphere(1, 1.3f);
    FaceLabels labels{{"a", "b", "c"}, {}};
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) labels.label.push_back(static_cast<std::int32_t>(f % 3));
    write_gltf(folder / "a.glb", mesh, labels);
    const std::string bytes = read_file(folder / "a.glb");
    std::uint32_t length = 0, json_length = 0;
    std::memcpy(&length, bytes.data() + 8, 4);
    std::memcpy(&json_length, bytes.data() + 12, 4);
    EXPECT_EQ(length, bytes.size());
    EXPECT_EQ(json_length % 4, 0u);
    const auto json = nlohmann::json::parse(bytes.substr(20, json_length));
    std::size_t index_count = 0;
    for (const auto& accessor : json["accessors"]) {
        const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
        const std::size_t offset = view["byteOffset"].get<std::size_t>() + accessor.value("byteOffset", std::size_t{0});
        EXPECT_EQ(offset % 4, 0u);
        if (accessor["type"] == "SCALAR") index_count += accessor["count"].get<std::size_t>();
    }
    EXPECT_EQ(index_count, 3 * mesh.face_count());
    for (int i = 0; i < 3; ++i) {
        float low = mesh.vertices[0][i], high = low;
        for (const Vec3& p : mesh.vertices) {
            low = std::min(low, p[i]);
            high = std::max(high, p[i]);
        }
        EXPECT_EQ(json["accessors"][0]["min"][i].get<float>(), low);
        EXPECT_EQ(json["accessors"][0]["max"][i].get<float>(), high);
    }
}

/// A sphere whose coordinates use all digits of a float.
TriangleMesh rough_sphere() {
    return shapes::transformed(shapes::icosphere(2, 0.7f),
                               [](const Vec3& p) -> Vec3 { return p / 3 + Vec3(1e-6f, 1e3f, 0); });
}
FaceLabels striped_labels(std::size_t faces, bool with_unlabeled) {
    FaceLabels labels{{"head", "a b", "unused", "\xc3\xa4rm"}, {}};
    for (std::size_t f = 0; f < faces; ++f) {
        const std::int32_t label = static_cast<std::int32_t>(f * 7 % 4);
        labels.label.push_back(label == 2 ? (with_unlabeled ? -1 : 0) : label);
    }
    return labels;
}

TEST(RoundTrip, GeometryIsExactInEveryFormat) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = rough_sphere();
    write_off(folder / "a.off", mesh);
    write_obj(folder / "a.obj", mesh);
    write_ply(folder / "a.ply", mesh);
    write_gltf(folder / "a.glb", mesh, {{"one"}, std::vector<std::int32_t>(mesh.face_count(), 0)});
    for (const char* name : {"a.off", "a.obj", "a.ply", "a.glb"}) {
        const MeshFile file = read_mesh(folder / name);
        EXPECT_EQ(file.mesh.vertices, mesh.vertices) << name;
        EXPECT_EQ(file.mesh.faces, mesh.faces) << name;
        EXPECT_EQ(file.mesh.source_face_count, mesh.face_count()) << name;
        EXPECT_THAT(file.mesh.source_face, testing::IsEmpty()) << name;
        EXPECT_THAT(file.warnings, testing::IsEmpty()) << name;
    }
}

TEST(RoundTrip, NotANumberSurvivesTextAndPly) {
    const TemporaryFolder folder;
    TriangleMesh mesh = small_mesh();
    mesh.vertices[1] = {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 1};
    write_off(folder / "a.off", mesh);
    write_obj(folder / "a.obj", mesh);
    write_ply(folder / "a.ply", mesh);
    for (const char* name : {"a.off", "a.obj", "a.ply"}) {
        const Vec3 p = read_mesh(folder / name).mesh.vertices[1];
        EXPECT_TRUE(std::isnan(p[0])) << name;
        EXPECT_EQ(p[1], -std::numeric_limits<float>::infinity()) << name;
    }
}

TEST(RoundTrip, PlyKeepsLabelsAndTheirNames) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = rough_sphere();
    const FaceLabels labels = striped_labels(mesh.face_count(), true);
    write_ply(folder / "a.ply", mesh, &labels);
    const auto read = read_mesh(folder / "a.ply").labels;
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->names, labels.names);
    EXPECT_EQ(read->label, labels.label);
}

TEST(RoundTrip, PlyKeepsConfidences) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = rough_sphere();
    const FaceLabels labels = striped_labels(mesh.face_count(), true);
    std::vector<float> confidence;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) confidence.push_back(static_cast<float>(f) / 1000);
    write_ply(folder / "a.ply", mesh, &labels, confidence);
    EXPECT_EQ(read_mesh(folder / "a.ply").confidence, confidence);
    write_ply(folder / "b.ply", mesh, &labels);
    EXPECT_THAT(read_mesh(folder / "b.ply").confidence, testing::IsEmpty());
}

TEST(RoundTrip, GltfKeepsNamesPerFace) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = rough_sphere();
    const FaceLabels labels = striped_labels(mesh.face_count(), true);
    write_gltf(folder / "a.glb", mesh, labels);
    const MeshFile file = read_mesh(folder / "a.glb");
    ASSERT_TRUE(file.labels.has_value());
    EXPECT_THAT(file.labels->names, ElementsAre("head", "a b", "\xc3\xa4rm"));
    const auto named_faces = [](const TriangleMesh& m, const FaceLabels& l) {
        std::vector<std::pair<Face, std::string>> faces;
        for (std::uint32_t f = 0; f < m.face_count(); ++f)
            faces.push_back({m.faces[f], l.label[f] < 0 ? "" : l.names[static_cast<std::size_t>(l.label[f])]});
        std::sort(faces.begin(), faces.end());
        return faces;
    };
    EXPECT_EQ(named_faces(file.mesh, *file.labels), named_faces(mesh, labels));
}

TEST(RoundTrip, LabelsTxt) {
    const TemporaryFolder folder;
    FaceLabels labels = striped_labels(101, false);
    write_labels_txt(folder / "deep" / "er.txt" / "a_labels.txt", labels);
    const FaceLabels read = read_labels_txt(folder / "deep" / "er.txt" / "a_labels.txt", 101);
    EXPECT_THAT(read.names, ElementsAre("head", "a b", "\xc3\xa4rm"));
    for (std::size_t f = 0; f < 101; ++f)
        EXPECT_EQ(read.names[static_cast<std::size_t>(read.label[f])],
                  labels.names[static_cast<std::size_t>(labels.label[f])]);
}

TEST(Writers, RefuseWhatDoesNotFit) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = small_mesh();
    FaceLabels labels = small_labels();
    labels.label.pop_back();
    EXPECT_THAT(error_of<UsageError>([&] { write_ply(folder / "a.ply", mesh, &labels); }), HasSubstr("2 labels"));
    labels.label.push_back(3);
    EXPECT_THAT(error_of<UsageError>([&] { write_gltf(folder / "a.glb", mesh, labels); }),
                HasSubstr("face 2 has label 3"));
    labels.label.back() = -2;
    EXPECT_THAT(error_of<UsageError>([&] { write_seg(folder / "a.seg", mesh, labels); }),
                HasSubstr("face 2 has label -2"));
    labels.label.back() = 0;
    EXPECT_THAT(error_of<UsageError>([&] { write_ply(folder / "a.ply", mesh, &labels, std::vector<float>(2)); }),
                HasSubstr("2 confidences"));
    EXPECT_THAT(error_of<DataError>([&] { write_labels_txt(folder / "a.txt", labels); }),
                HasSubstr("face 2 has no label"));
    for (const std::string& name :
         {std::string(), std::string("two\nlines"), std::string(" padded"), std::string("bell\a")}) {
        FaceLabels bad{{name}, {0, 0, 0}};
        EXPECT_THAT(error_of<DataError>([&] { write_ply(folder / "a.ply", mesh, &bad); }), HasSubstr("label 0"));
        EXPECT_THAT(error_of<DataError>([&] { write_labels_txt(folder / "a.txt", bad); }), HasSubstr("label 0"));
    }
    TriangleMesh infinite = mesh;
    infinite.vertices[3].x() = INFINITY;
    EXPECT_THAT(error_of<MeshError>([&] { write_gltf(folder / "a.glb", infinite, small_labels()); }),
                HasSubstr("vertex 3"));
    EXPECT_THAT(error_of<MeshError>([&] { write_gltf(folder / "a.glb", {}, {}); }), HasSubstr("without faces"));
    for (const char* name : {"a.ply", "a.glb", "a.seg", "a.txt"})
        EXPECT_FALSE(std::filesystem::exists(folder / name)) << name;
}

TEST(Writers, SayWhereTheyCannotWrite) {
    const TemporaryFolder folder;
    mesh_files::write_bytes(folder / "file", "x");
    EXPECT_THAT(error_of<DataError>([&] { write_off(folder / "file" / "a.off", small_mesh()); }), HasSubstr("a.off"));
}

TEST(Writers, EmptyMeshesAreWrittenAndReadBack) {
    const TemporaryFolder folder;
    write_off(folder / "a.off", {});
    write_ply(folder / "a.ply", {});
    EXPECT_EQ(read_mesh(folder / "a.off").mesh.face_count(), 0u);
    EXPECT_EQ(read_mesh(folder / "a.ply").mesh.vertex_count(), 0u);
}

TEST(WritePly, KeepsThePolygonsOfAFile) {
    const std::string off =
        "OFF\n6 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n2 1 1\n4 0 1 2 3\n2 0 1\n3 1 4 2\n5 1 4 5 2 3\n";
    const MeshFile file = mesh_files::read_as("a.off", off);
    EXPECT_THAT(file.polygons.corner_counts, ElementsAre(4, 2, 3, 5));
    const FaceLabels labels{{"a", "b"}, {0, 1, -1, 1}};
    const std::vector<float> confidence{0.1f, 0.2f, 0.3f, 0.4f};
    const TemporaryFolder folder;
    write_ply(folder / "b.ply", file.mesh, &labels, confidence, &file.polygons);
    EXPECT_THAT(read_file(folder / "b.ply"), HasSubstr("element face 4\n"));
    const MeshFile again = read_mesh(folder / "b.ply");
    EXPECT_EQ(again.polygons.corner_counts, file.polygons.corner_counts);
    EXPECT_EQ(again.polygons.corners, file.polygons.corners);
    EXPECT_EQ(again.mesh.faces, file.mesh.faces);
    EXPECT_EQ(again.mesh.source_face, file.mesh.source_face);
    EXPECT_EQ(again.labels->label, labels.label);
    EXPECT_EQ(again.confidence, confidence);
}

TEST(WritePly, CountsOfManyCornersTakeMoreThanAByte) {
    std::string off = "OFF\n300 2 0\n", polygon = "300";
    for (int i = 0; i < 300; ++i) {
        off += fmt::format("{} {} 0\n", std::cos(i * 0.02), std::sin(i * 0.02));
        polygon += fmt::format(" {}", i);
    }
    const MeshFile file = mesh_files::read_as("a.off", off + polygon + "\n3 0 1 2\n");
    const TemporaryFolder folder;
    write_ply(folder / "b.ply", file.mesh, nullptr, {}, &file.polygons);
    EXPECT_THAT(read_mesh(folder / "b.ply").polygons.corner_counts, ElementsAre(300, 3));
}

TEST(WritePly, RefusesPolygonsOfAnotherMesh) {
    const TemporaryFolder folder;
    const auto write = [&](const Polygons& polygons) {
        return error_of<UsageError>([&] { write_ply(folder / "b.ply", small_mesh(), nullptr, {}, &polygons); });
    };
    EXPECT_THAT(write({{4, 2}, {0, 1, 2, 3, 0, 1}}), HasSubstr("polygons"));
    EXPECT_THAT(write({{4, 2, 3}, {0, 1, 2, 3, 0, 1, 1, 3, 9}}), HasSubstr("polygons"));
    EXPECT_THAT(write({{4, 2, 3}, {0, 1, 2, 3, 0, 1, 1, 3}}), HasSubstr("polygons"));
}

TEST(ReadPolygons, AreKeptOnlyIfNotAllAreTriangles) {
    EXPECT_TRUE(mesh_files::read_as("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").polygons.corners.empty());
    const MeshFile quad = mesh_files::read_as("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    EXPECT_THAT(quad.polygons.corners, ElementsAre(0, 1, 2, 3));
}

}  // namespace
}  // namespace exemplar
