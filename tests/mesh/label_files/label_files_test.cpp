// Labels in the formats of other programs: round trips, files as others write them, and refused ones.
#include "host/mesh/label_files/label_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "host/core/text.h"
#include "host/mesh/label_files/vertex_labels.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::error_of;
using mesh_files::write_bytes;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two quads and a triangle: a strip of six vertices along x, and a seventh.
constexpr const char* k_strip_off =
    "OFF\n7 3 0\n0 0 0\n1 0 0\n2 0 0\n2 1 0\n1 1 0\n0 1 0\n3 0.5 0\n4 0 1 4 5\n4 1 2 3 4\n3 2 6 3\n";

MeshFile strip() {
    return mesh_files::read_as("strip.off", k_strip_off);
}

FaceLabels read_label_bytes(const std::string& file_name, const std::string& bytes, const TriangleMesh& mesh) {
    const TemporaryFolder folder;
    write_bytes(folder / file_name, bytes);
    return read_face_labels(folder / file_name, mesh);
}

std::string refusal(const std::string& file_name, const std::string& bytes) {
    std::string message = error_of<DataError>([&] { read_label_bytes(file_name, bytes, strip().mesh); });
    EXPECT_THAT(message, HasSubstr(file_name)) << "names the file";
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
}

/// The name of each face's label; empty without one.
std::vector<std::string> face_names(const FaceLabels& labels) {
    std::vector<std::string> names;
    for (const std::int32_t label : labels.label)
        names.push_back(label < 0 ? "" : labels.names[static_cast<std::size_t>(label)]);
    return names;
}

TEST(LabelFiles, FaceFormsAreReadAgain) {
    const MeshFile file = strip();
    const FaceLabels labels{{"left", "middle \"x\" \xc3\xa4", "right"}, {2, 1, 0}};
    const TemporaryFolder folder;
    for (const char* form : {"json", "npy", "vtp"}) {
        SCOPED_TRACE(form);
        const FaceLabels read = read_face_labels(write_label_file(folder / "a", form, file, labels), file.mesh);
        EXPECT_EQ(read.label, labels.label);
        EXPECT_EQ(read.names, form == std::string("npy") ? std::vector<std::string>({"0", "1", "2"}) : labels.names);
    }
}

TEST(LabelFiles, UnlabeledFacesStayUnlabeled) {
    const MeshFile file = strip();
    const FaceLabels labels{{"a"}, {-1, 0, -1}};
    const TemporaryFolder folder;
    for (const char* form : {"json", "npy", "vtp"})
        EXPECT_EQ(read_face_labels(write_label_file(folder / "a", form, file, labels), file.mesh).label, labels.label);
}

TEST(LabelFiles, VertexFormsKeepTheInnerFaces) {
    MeshFile file;
    file.mesh = shapes::icosphere(4, 1);
    FaceLabels labels{{"low", "high"}, {}};
    for (const Vec3& p : face_centers(file.mesh)) labels.label.push_back(p.z() > 0.1F ? 1 : 0);
    const TemporaryFolder folder;
    for (const char* form : {"vertices", "vertices-json"}) {
        const FaceLabels read = read_face_labels(write_label_file(folder / "a", form, file, labels), file.mesh);
        std::size_t equal = 0;
        for (std::size_t f = 0; f < labels.label.size(); ++f) equal += read.label[f] == labels.label[f] ? 1 : 0;
        EXPECT_GT(static_cast<double>(equal), 0.97 * static_cast<double>(labels.label.size())) << form;
        EXPECT_EQ(read.names, form == std::string("vertices") ? std::vector<std::string>({"0", "1"}) : labels.names);
    }
}

TEST(LabelFiles, TeethHaveTheirNumbers) {
    const MeshFile file = strip();
    const TemporaryFolder folder;
    const FaceLabels labels{{"0", "18", "17"}, {0, 1, 1}};
    const auto path = write_label_file(folder / "a", "vertices-json", file, labels);
    const auto json = nlohmann::json::parse(read_file(path));
    EXPECT_EQ(json["labels"], nlohmann::json({0, 0, 18, 18, 0, 0, 18}));
    EXPECT_EQ(json["instances"], nlohmann::json({0, 0, 1, 1, 0, 0, 1}));
    EXPECT_THAT(face_names(read_face_labels(path, file.mesh)), ElementsAre("0", testing::_, "18"))
        << "the second has as many of both";
    const std::string of_others = R"({"id_patient": "A", "jaw": "lower", "labels": [0, 0, 31, 31, 0, 0, 31], )"
                                  R"("instances": [0, 0, 1, 1, 0, 0, 1]})";
    EXPECT_THAT(face_names(read_label_bytes("A_lower.json", of_others, file.mesh)), ElementsAre("0", "0", "31"));
}

TEST(VertexLabels, CornerAnglesDecide) {
    TriangleMesh mesh;  // at vertex 0 a corner of 90 degrees and one of 45
    mesh.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 1, 0), Vec3(5, 5, 5)};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    mesh.source_face_count = 2;
    EXPECT_THAT(labels_of_vertices(mesh, std::vector<std::int32_t>{7, 3}), ElementsAre(7, 7, 3, 3, -1));
    EXPECT_THAT(labels_of_faces(mesh, std::vector<std::int32_t>{1, 2, 2, 5, -1}), ElementsAre(2, 2));
    EXPECT_THAT(labels_of_faces(mesh, std::vector<std::int32_t>{1, 2, 3, -1, -1}), ElementsAre(1, 3));
    EXPECT_THAT(labels_of_faces(mesh, std::vector<std::int32_t>{-1, -1, -1, 4, 4}), ElementsAre(-1, 4));
}

TEST(LabelFiles, NumberListsAreOfFacesOrVertices) {
    const MeshFile file = strip();
    EXPECT_THAT(face_names(read_label_bytes("a.txt", "4\n\n2\r\n2\n", file.mesh)), ElementsAre("4", "2", "2"));
    EXPECT_THAT(face_names(read_label_bytes("a.txt", "1\n1\n1\n0\n1\n1\n0\n", file.mesh)), ElementsAre("1", "1", "0"));
    EXPECT_THAT(face_names(read_label_bytes("a.txt", "wing\n1 3\ntail\n2\n", file.mesh)),
                ElementsAre("wing", "tail", "wing"));
    EXPECT_THAT(refusal("a.txt", "1\n2\n"), HasSubstr("3 faces and 7 vertices"));
    EXPECT_THAT(refusal("a.txt", "1\n2\n99999999999\n"), HasSubstr("a.txt:3"));
    EXPECT_THAT(refusal("a.txt", "1\n-2\n1\n"), HasSubstr("a.txt:2"));
}

TEST(LabelFiles, SegmentsHaveNames) {
    const MeshFile file = strip();
    const TemporaryFolder folder;
    write_bytes(folder / "a.seg", "1\n0\n1\n");
    EXPECT_THAT(face_names(read_face_labels(folder / "a.seg", file.mesh)),
                ElementsAre("segment 1", "segment 0", "segment 1"));
    write_bytes(folder / "a.names", "leg\nhead of it\n");
    EXPECT_THAT(face_names(read_face_labels(folder / "a.seg", file.mesh)),
                ElementsAre("head of it", "leg", "head of it"));
    write_bytes(folder / "a.names", "leg\n");
    EXPECT_THAT(error_of<DataError>([&] { read_face_labels(folder / "a.seg", file.mesh); }), HasSubstr("a.seg:1"));
    EXPECT_THAT(face_names(read_label_bytes("b.seg", "leg\nhead\nleg\n", file.mesh)),
                ElementsAre("leg", "head", "leg"));
    EXPECT_THAT(refusal("b.seg", "leg\nhead\n"), HasSubstr("2 lines"));
    EXPECT_THAT(refusal("b.seg", "a\nb\nc\nd\n"), HasSubstr("b.seg:4"));
    EXPECT_THAT(refusal("b.seg", "0\n1\n7\n"), HasSubstr("b.seg:3"));
}

TEST(LabelFiles, GroupsOfObjAreLabels) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    const auto read = [&](const std::string& faces) {
        const TemporaryFolder folder;
        write_bytes(folder / "a.obj", vertices + faces);
        return face_names(read_face_labels(folder / "a.obj", read_mesh(folder / "a.obj").mesh));
    };
    EXPECT_THAT(read("o thing\ng left arm\nf 1 2 3\ng head\nf 1 3 4\nf 1 \\\n 2 4\n"),
                ElementsAre("left arm", "head", "head"));
    EXPECT_THAT(read("o thing\nusemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\n"), ElementsAre("red", "blue"));
    EXPECT_THAT(read("o one\nusemtl red\nf 1 2 3\no two\nf 1 3 4\n"), ElementsAre("one", "two"));
    EXPECT_THAT(read("f 1 2 3\ng\nf 1 3 4\n"), ElementsAre("", "default"));
    EXPECT_THAT(error_of<DataError>([&] { read("f 1 2 3\n"); }), HasSubstr("no groups"));
    EXPECT_THAT(error_of<DataError>([&] { read("g \xff\nf 1 2 3\n"); }), HasSubstr("a.obj:5"));
    EXPECT_THAT(refusal("a.obj", vertices + "g a\nf 1 2 3\n"), HasSubstr("1 faces, but the mesh has 3"));
}

TEST(LabelFiles, MaterialsOfGltfAreLabels) {
    std::string json = mesh_files::tetrahedron_gltf("");
    json.replace(json.find("\"indices\":1}"), 12,
                 R"("indices":1,"material":1},{"attributes":{"POSITION":0},"indices":1,"material":0},)"
                 R"({"attributes":{"POSITION":0},"indices":1})");
    json.insert(json.size() - 1, R"(,"materials":[{"name":"skin"},{}])");
    const std::string glb =
        mesh_files::glb_of(json, mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices());
    const TemporaryFolder folder;
    write_bytes(folder / "a.glb", glb);
    const FaceLabels labels = read_face_labels(folder / "a.glb", read_mesh(folder / "a.glb").mesh);
    EXPECT_THAT(labels.names, ElementsAre("material 1", "skin"));
    EXPECT_THAT(labels.label, ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, -1, -1, -1, -1));
}

TEST(LabelFiles, AttributesOfGltfAreLabels) {
    std::string json = mesh_files::tetrahedron_gltf("");
    json.replace(json.find("\"POSITION\":0"), 12, R"("POSITION":0,"_LABEL":2)");
    json.replace(json.find("],\"bufferViews\":["), 1,
                 R"(,{"bufferView":2,"componentType":5126,"count":4,"type":"SCALAR"}])");
    json.replace(json.find("\"byteLength\":24}"), 16,
                 R"("byteLength":24},{"buffer":0,"byteOffset":72,"byteLength":16})");
    json.replace(json.find("\"byteLength\":72"), 15, "\"byteLength\":88");
    const auto glb = [&](std::initializer_list<float> values) {
        std::string binary = mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices();
        for (const float value : values) binary += bytes_of(value);
        return mesh_files::glb_of(json, binary);
    };
    const auto read = [&](const std::string& bytes) {
        const TemporaryFolder folder;
        write_bytes(folder / "a.glb", bytes);
        return face_names(read_face_labels(folder / "a.glb", read_mesh(folder / "a.glb").mesh));
    };
    // The triangles are 0 2 1, 0 1 3, 0 3 2 and 1 2 3.
    EXPECT_THAT(read(glb({4, 4, 7, 7})), ElementsAre("4", "4", "7", "7"));
    EXPECT_THAT(read(glb({4, 5, 6, 5})), ElementsAre("4", "5", "4", "5"));
    EXPECT_THAT(error_of<DataError>([&] { read(glb({4, 4.5F, 7, 7})); }), HasSubstr("no materials"));
}

// A triangle follows the joint with the largest weight over its corners, as groups of vertices are exported.
TEST(LabelFiles, JointsOfGltfAreLabelsIfAskedFor) {
    std::string json = mesh_files::tetrahedron_gltf("", "[{'mesh':0,'skin':0,'children':[1,2]},{'name':'arm'},{}]");
    json.insert(json.size() - 1, R"(,"skins":[{"joints":[1,2]}])");
    json.replace(json.find("\"POSITION\":0"), 12, R"("POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3)");
    json.replace(json.find("],\"bufferViews\":["), 1,
                 R"(,{"bufferView":2,"componentType":5121,"count":4,"type":"VEC4"},)"
                 R"({"bufferView":3,"componentType":5126,"count":4,"type":"VEC4"}])");
    json.replace(json.find("\"byteLength\":24}"), 16,
                 R"("byteLength":24},{"buffer":0,"byteOffset":72,"byteLength":16},)"
                 R"({"buffer":0,"byteOffset":88,"byteLength":64})");
    json.replace(json.find("\"byteLength\":72"), 15, "\"byteLength\":152");
    std::string binary = mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices();
    for (int vertex = 0; vertex < 4; ++vertex) binary += std::string("\0\1\0\0", 4);
    for (const float of_second : {1.0F, 1.0F, 0.0F, 0.25F})
        for (const float weight : {1 - of_second, of_second, 0.0F, 0.0F}) binary += bytes_of(weight);
    const TemporaryFolder folder;
    write_bytes(folder / "a.glb", mesh_files::glb_of(json, binary));
    const TriangleMesh mesh = read_mesh(folder / "a.glb").mesh;
    // The triangles are 0 2 1, 0 1 3, 0 3 2 and 1 2 3; the second joint has no name.
    EXPECT_THAT(face_names(read_face_labels(folder / "a.glb", mesh)), ElementsAre("joint 2", "joint 2", "arm", "arm"));
    EXPECT_FALSE(find_other_labels(folder / "a.glb", mesh)) << "a character in a folder has no labels yet";
}

/// A file as VTK writes it; `array` is the element of the labels, `rest` what follows the data set.
std::string vtp(const std::string& array, const std::string& attributes = "", const std::string& rest = "") {
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" " +
           attributes +
           ">\n<PolyData><Piece NumberOfPoints=\"7\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
           "NumberOfStrips=\"0\" NumberOfPolys=\"3\"><PointData><DataArray type=\"Int32\" Name=\"Label\" "
           "format=\"ascii\">9 9 9 9 9 9 9</DataArray></PointData><CellData>" +
           array + "</CellData></Piece></PolyData>\n" + rest + "</VTKFile>\n";
}

std::string int32_bytes(std::initializer_list<int> values) {
    std::string bytes;
    for (const int value : values) bytes += bytes_of(value);
    return bytes;
}

std::string deflated(const std::string& bytes) {
    std::string packed(compressBound(bytes.size()), '\0');
    uLongf size = packed.size();
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
             bytes.size());
    packed.resize(size);
    return packed;
}

TEST(LabelFiles, EncodingsOfVtpAreRead) {
    const TriangleMesh mesh = strip().mesh;
    const auto read = [&](const std::string& bytes) { return face_names(read_label_bytes("a.vtp", bytes, mesh)); };
    const auto array = [](const std::string& inside, const std::string& text = "") {
        return "<DataArray Name=\"Label\" " + inside + ">" + text + "</DataArray>";
    };
    const auto expected = ElementsAre("5", "6", "5");
    const std::string plain = int32_bytes({5, 6, 5}), length = bytes_of(12U), wide = bytes_of(std::uint64_t{12});
    EXPECT_THAT(read(vtp(array("type=\"Float32\" format=\"ascii\"", " 5 6.0\n5 "))), expected);
    EXPECT_THAT(read(vtp(array("type=\"Int32\" format=\"binary\"", "\n  " + base64(length + plain) + "\n"))), expected);
    EXPECT_THAT(read(vtp(array("type=\"Int32\" format=\"binary\"", base64(length) + base64(plain)))), expected);
    EXPECT_THAT(read(vtp(array("type=\"Int32\" format=\"binary\"", base64(wide + plain)), "header_type=\"UInt64\"")),
                expected);
    const std::string in_place = array("type=\"Int32\" format=\"appended\" offset=\"3\"");
    EXPECT_THAT(
        read(vtp(in_place, "", "<AppendedData encoding=\"raw\">\n _<&\x01" + length + plain + "</AppendedData>")),
        expected);
    const std::string in_text = array("type=\"Int32\" format=\"appended\" offset=\"4\"");
    EXPECT_THAT(
        read(vtp(in_text, "", "<AppendedData encoding=\"base64\">_AAAA" + base64(length + plain) + "</AppendedData>")),
        expected);
    const std::string zlib = "compressor=\"vtkZLibDataCompressor\" header_type=\"UInt32\"";
    const std::string first = deflated(int32_bytes({5, 6})), second = deflated(int32_bytes({5}));
    const std::string lengths = bytes_of(2U) + bytes_of(8U) + bytes_of(4U) +
                                bytes_of(static_cast<std::uint32_t>(first.size())) +
                                bytes_of(static_cast<std::uint32_t>(second.size()));
    EXPECT_THAT(read(vtp(array("type=\"Int32\" format=\"binary\"", base64(lengths) + base64(first + second)), zlib)),
                expected);
    const std::string whole = deflated(plain);
    const std::string one =
        bytes_of(1U) + bytes_of(32768U) + bytes_of(12U) + bytes_of(static_cast<std::uint32_t>(whole.size()));
    EXPECT_THAT(read(vtp(array("type=\"Int32\" format=\"binary\"", base64(one) + base64(whole)), zlib)), expected);
    EXPECT_THAT(read(vtp(array("type=\"UInt8\" format=\"binary\"", base64(bytes_of(3U) + "\5\6\5")))), expected);
}

TEST(LabelFiles, ArraysOfVtpAreChosenByName) {
    const TriangleMesh mesh = strip().mesh;
    const std::string other = "<DataArray type=\"Int32\" Name=\"Area\" format=\"ascii\">1 2 3</DataArray>";
    const std::string normals =
        "<DataArray type=\"Float32\" Name=\"N\" NumberOfComponents=\"3\" format=\"ascii\">0 0 1</DataArray>";
    EXPECT_THAT(face_names(read_label_bytes("a.vtp", vtp(normals + other), mesh)), ElementsAre("1", "2", "3"));
    const std::string named = "<DataArray type=\"Int32\" Name=\"MaterialIds\" format=\"ascii\">8 8 9</DataArray>";
    EXPECT_THAT(face_names(read_label_bytes("a.vtp", vtp(other + named), mesh)), ElementsAre("8", "8", "9"));
    EXPECT_THAT(refusal("a.vtp", vtp(other + other)), HasSubstr("2 arrays"));
    EXPECT_THAT(refusal("a.vtp", vtp("")), HasSubstr("0 arrays"));
}

TEST(LabelFiles, DamagedVtpIsRefused) {
    const auto labeled = [](const std::string& inside, const std::string& text) {
        return "<DataArray Name=\"Label\" " + inside + ">" + text + "</DataArray>";
    };
    EXPECT_THAT(refusal("a.vtp", "<VTKFile"), HasSubstr("XML"));
    EXPECT_THAT(refusal("a.vtp", "<VTKFile type=\"UnstructuredGrid\"/>"), HasSubstr("PolyData"));
    EXPECT_THAT(refusal("a.vtp", "<VTKFile type=\"PolyData\" compressor=\"vtkLZ4DataCompressor\"/>"),
                HasSubstr("zlib"));
    EXPECT_THAT(refusal("a.vtp", "<VTKFile type=\"PolyData\" byte_order=\"BigEndian\"/>"), HasSubstr("little-endian"));
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"ascii\"", "1 2"))), HasSubstr("2 values, not 3"));
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"ascii\"", "1 2 x"))), HasSubstr("'x'"));
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Float32\" format=\"ascii\"", "1 2 0.5"))), HasSubstr("0.5"));
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"binary\"", "AAAA"))), HasSubstr("cut off"));
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"binary\"", "AA?A"))), HasSubstr("base64"));
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"appended\" offset=\"99\"", ""), "",
                                     "<AppendedData encoding=\"raw\">_abc</AppendedData>")),
                HasSubstr("behind the end"));
    const std::string blocks = bytes_of(1U) + bytes_of(12U) + bytes_of(0U) + bytes_of(4U);
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"binary\"", base64(blocks) + base64("junk")),
                                     "compressor=\"vtkZLibDataCompressor\"")),
                HasSubstr("block 0 is damaged"));
    const std::string many = bytes_of(0xffffffffU) + bytes_of(0xffffffffU) + bytes_of(1U);
    EXPECT_THAT(refusal("a.vtp", vtp(labeled("type=\"Int32\" format=\"binary\"", base64(many)),
                                     "compressor=\"vtkZLibDataCompressor\"")),
                HasSubstr("blocks of another size"));
}

TEST(LabelFiles, NumpyTypesAreRead) {
    const TriangleMesh mesh = strip().mesh;
    const auto npy = [](const std::string& descr, const std::string& shape, const std::string& data) {
        std::string header = "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }";
        header.resize(117, ' ');
        return std::string("\x93NUMPY\1\0", 8) + bytes_of(std::uint16_t{118}) + header + "\n" + data;
    };
    EXPECT_THAT(face_names(read_label_bytes("a.npy", npy("|u1", "(3,)", "\3\4\3"), mesh)), ElementsAre("3", "4", "3"));
    EXPECT_THAT(face_names(read_label_bytes("a.npy", npy("<i8", "(3,)", int32_bytes({1, 0, -1, -1, 2, 0})), mesh)),
                ElementsAre("1", "", "2"));
    EXPECT_THAT(face_names(read_label_bytes("a.npy", npy("|i1", "(7,)", std::string("\0\0\1\1\0\0\1", 7)), mesh)),
                ElementsAre("0", "0", "1"));
    EXPECT_THAT(refusal("a.npy", npy("<f4", "(3,)", int32_bytes({1, 2, 3}))), HasSubstr("integers"));
    EXPECT_THAT(refusal("a.npy", npy("<i4", "(3, 2)", int32_bytes({1, 2, 3, 4, 5, 6}))), HasSubstr("one-dimensional"));
    EXPECT_THAT(refusal("a.npy", npy("<i4", "(3,)", "abc")), HasSubstr("cut off"));
    EXPECT_THAT(refusal("a.npy", npy("<i4", "(2,)", int32_bytes({1, 2}))), HasSubstr("2 labels"));
    EXPECT_THAT(refusal("a.npy", "PK"), HasSubstr("byte 0"));
    EXPECT_THAT(refusal("a.npy", std::string("\x93NUMPY\1\0\xff\xff", 10) + "{}"), HasSubstr("cut off"));
}

TEST(LabelFiles, DamagedJsonIsRefused) {
    EXPECT_THAT(refusal("a.json", "{\"labels\": [\"a\"], \"faces\": [0, 0"), HasSubstr("byte"));
    EXPECT_THAT(refusal("a.json", "[]"), HasSubstr("object"));
    EXPECT_THAT(refusal("a.json", "{}"), HasSubstr("'labels'"));
    EXPECT_THAT(refusal("a.json", R"({"labels": ["a"]})"), HasSubstr("'faces'"));
    EXPECT_THAT(refusal("a.json", R"({"labels": ["a"], "faces": [0, 0, 1]})"), HasSubstr("label 1"));
    EXPECT_THAT(refusal("a.json", R"({"labels": ["a", ""], "faces": [0, 0, 1]})"), HasSubstr("entry 1"));
    EXPECT_THAT(refusal("a.json", R"({"labels": ["a"], "faces": [0, 0]})"), HasSubstr("2 faces"));
    EXPECT_THAT(refusal("a.json", R"({"labels": [0, 1.5, 0]})"), HasSubstr("entry 1"));
    EXPECT_THAT(refusal("a.json", "{\"labels\":" + std::string(40, '[') + std::string(40, ']') + "}"),
                HasSubstr("deep"));
}

TEST(LabelFiles, LabelsBesideAMeshAreFound) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.off", k_strip_off);
    const TriangleMesh mesh = strip().mesh;
    EXPECT_FALSE(find_other_labels(folder / "a.off", mesh));
    write_bytes(folder / "a.seg", "0\n1\n1\n");
    EXPECT_FALSE(find_other_labels(folder / "a.off", mesh)) << "segments without names are no labels";
    write_bytes(folder / "a.names", "x\ny\n");
    EXPECT_THAT(face_names(*find_other_labels(folder / "a.off", mesh)), ElementsAre("x", "y", "y"));
    write_bytes(folder / "a.json", R"({"labels": [7, 7, 8, 8, 7, 7, 8]})");
    EXPECT_THAT(face_names(*find_other_labels(folder / "a.off", mesh)), ElementsAre("7", "7", "8"));
    write_bytes(folder / "b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nf 1 2 3\n");
    EXPECT_FALSE(find_other_labels(folder / "b.obj", read_mesh(folder / "b.obj").mesh)) << "one group tells nothing";
}

TEST(LabelFiles, UnknownFormsAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THAT(error_of<UsageError>([&] {
                    write_label_file(folder / "a", "xml", strip(), {{"a"}, {0, 0, 0}});
                }),
                HasSubstr("vertices-json"));
    EXPECT_THROW(write_label_file(folder / "a", "json", strip(), {{"a"}, {0, 0}}), UsageError);
}

/// Whatever file labels come in, they are those of the faces.
TEST(LabelFiles, AreReadByTheirEnding) {
    const TemporaryFolder folder;
    const TriangleMesh strip = shapes::grid(2, 1, 2);
    const FaceLabels labels{{"leg", "arm"}, {0, 1, 1, 0}};
    write_labels_txt(folder / "a_labels.txt", labels);
    write_ply(folder / "a.ply", strip, &labels);
    mesh_files::write_bytes(folder / "a.seg", "0\n2\n2\n0\n");
    for (const char* name : {"a_labels.txt", "a.ply"}) {
        const FaceLabels read = read_face_labels(folder / name, strip);
        EXPECT_THAT(read.names, ElementsAre("leg", "arm")) << name;
        EXPECT_EQ(read.label, labels.label) << name;
        EXPECT_THROW(read_face_labels(folder / name, shapes::grid(1, 1, 1)), DataError) << name;
    }
    const FaceLabels segments = read_face_labels(folder / "a.seg", strip);
    EXPECT_THAT(segments.names, ElementsAre("segment 0", "segment 1", "segment 2"));
    EXPECT_THAT(segments.label, ElementsAre(0, 2, 2, 0));
    write_off(folder / "plain.off", strip);
    EXPECT_THAT(error_of<DataError>([&] { read_face_labels(folder / "plain.off", strip); }), HasSubstr("no labels"));
}

}  // namespace
}  // namespace exemplar
