// glTF files whose geometry is compressed (EXT_meshopt_compression, KHR_draco_mesh_compression) or quantized
// (KHR_mesh_quantization), made with the libraries' encoders.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>

#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::glb_of;
using mesh_files::json_text;
using mesh_files::read_as;
using testing::HasSubstr;

const std::vector<Vec3> k_corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<unsigned> k_indices{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

using Triangle = std::array<std::array<float, 3>, 3>;

/// The corners of each triangle, the least first, sorted: codecs turn triangles and change their order.
std::vector<Triangle> triangles_of(const TriangleMesh& mesh) {
    std::vector<Triangle> triangles;
    for (const Face& face : mesh.faces) {
        Triangle triangle;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) triangle[i][k] = mesh.vertices[face[i]][static_cast<Eigen::Index>(k)];
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        triangles.push_back(triangle);
    }
    std::ranges::sort(triangles);
    return triangles;
}

std::vector<Triangle> expected_triangles() {
    TriangleMesh mesh;
    mesh.vertices = k_corners;
    for (std::size_t i = 0; i < k_indices.size(); i += 3)
        mesh.faces.push_back({k_indices[i], k_indices[i + 1], k_indices[i + 2]});
    return triangles_of(mesh);
}

std::string text_of(const std::vector<unsigned char>& bytes) {
    return {bytes.begin(), bytes.end()};
}

std::string meshopt_positions() {
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(k_corners.size(), sizeof(Vec3)));
    bytes.resize(
        meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), k_corners.data(), k_corners.size(), sizeof(Vec3)));
    return text_of(bytes);
}
std::string meshopt_indices(bool triangles) {
    const auto bound = triangles ? meshopt_encodeIndexBufferBound : meshopt_encodeIndexSequenceBound;
    const auto encode = triangles ? meshopt_encodeIndexBuffer<unsigned> : meshopt_encodeIndexSequence<unsigned>;
    std::vector<unsigned char> bytes(bound(k_indices.size(), k_corners.size()));
    bytes.resize(encode(bytes.data(), bytes.size(), k_indices.data(), k_indices.size()));
    return text_of(bytes);
}

/// A tetrahedron whose two views are compressed; `edit` may change the document.
std::string meshopt_glb(const std::string& positions, const std::string& indices, const std::string& mode,
                        const std::string& from = "", const std::string& to = "") {
    const std::string binary = positions + indices;
    std::string json =
        "{'asset':{'version':'2.0'},'extensionsRequired':['EXT_meshopt_compression'],'nodes':[{'mesh':0}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
        "{'bufferView':1,'componentType':5123,'count':12,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':1,'byteLength':48,'byteStride':12,'extensions':{'EXT_meshopt_compression':"
        "{'buffer':0,'byteLength':" +
        std::to_string(positions.size()) +
        ",'byteStride':12,'mode':'ATTRIBUTES','count':4}}},{'buffer':1,'byteOffset':48,'byteLength':24,'extensions':"
        "{'EXT_meshopt_compression':{'buffer':0,'byteOffset':" +
        std::to_string(positions.size()) + ",'byteLength':" + std::to_string(indices.size()) +
        ",'byteStride':2,'mode':'" + mode +
        "','count':12}}}],'buffers':[{'byteLength':" + std::to_string(binary.size()) +
        "},{'byteLength':72,'extensions':{'EXT_meshopt_compression':{'fallback':true}}}]}";
    if (!from.empty()) {
        EXPECT_NE(json.find(from), std::string::npos) << from;
        json.replace(json.find(from), from.size(), to);
    }
    return glb_of(json_text(json), binary);
}

std::string error_of_glb(const std::string& bytes) {
    std::string message = mesh_files::error_of<MeshError>([&] { std::ignore = read_as("a.glb", bytes); });
    EXPECT_THAT(message, HasSubstr("a.glb: "));
    return message;
}

TEST(CompressedGltf, MeshoptViewsAreDecoded) {
    for (const bool triangles : {true, false}) {
        const MeshFile file = read_as(
            "a.glb", meshopt_glb(meshopt_positions(), meshopt_indices(triangles), triangles ? "TRIANGLES" : "INDICES"));
        EXPECT_EQ(file.mesh.vertices.size(), 4u);
        EXPECT_EQ(triangles_of(file.mesh), expected_triangles());
    }
}

TEST(CompressedGltf, MeshoptFiltersAreUndone) {
    std::vector<unsigned> filtered(12);
    meshopt_encodeFilterExp(filtered.data(), 4, 12, 15, k_corners.front().data());
    std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(4, 12));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), filtered.data(), 4, 12));
    const auto glb = [&](const std::string& filter) {
        return meshopt_glb(text_of(bytes), meshopt_indices(true), "TRIANGLES", "'mode':'ATTRIBUTES'",
                           "'mode':'ATTRIBUTES','filter':'" + filter + "'");
    };
    EXPECT_EQ(triangles_of(read_as("a.glb", glb("EXPONENTIAL")).mesh), expected_triangles());
    EXPECT_NE(triangles_of(read_as("a.glb", glb("NONE")).mesh), expected_triangles());
    EXPECT_THAT(error_of_glb(glb("QUATERNION")), HasSubstr("does not fit its stride"));
    EXPECT_THAT(error_of_glb(glb("OTHER")), HasSubstr("unknown filter"));
}

TEST(CompressedGltf, MeshoptViewsThatDoNotFitAreRefused) {
    const std::string positions = meshopt_positions(), indices = meshopt_indices(true);
    const auto error = [&](const std::string& from, const std::string& to) {
        return error_of_glb(meshopt_glb(positions, indices, "TRIANGLES", from, to));
    };
    EXPECT_THAT(error("'count':4}}", "'count':400000000}}"), HasSubstr("far more than its bytes can"));
    EXPECT_THAT(error("'count':4}}", "'count':5000}}"), HasSubstr("is damaged"));
    EXPECT_THAT(error("'count':4}}", "'count':3}}"), HasSubstr("4 elements of accessor 0"));
    EXPECT_THAT(error("'count':12}}", "'count':11}}"), HasSubstr("cannot hold 11 x 2"));
    EXPECT_THAT(error("'byteStride':2", "'byteStride':3"), HasSubstr("cannot hold 12 x 3"));
    EXPECT_THAT(error("'byteStride':12,'mode'", "'byteStride':260,'mode'"), HasSubstr("cannot hold 4 x 260"));
    EXPECT_THAT(error("'TRIANGLES'", "'OTHER'"), HasSubstr("unknown mode 'OTHER'"));
    EXPECT_THAT(error("'count':4}}", "'count':-4}}"), HasSubstr("no valid count"));
    EXPECT_THAT(error("{'buffer':0,'byteLength'", "{'buffer':7,'byteLength'"), HasSubstr("names buffer 7"));
    EXPECT_THAT(error("{'buffer':0,'byteLength':", "{'buffer':0,'byteLength':9"), HasSubstr("past the end"));
    EXPECT_THAT(error_of_glb(meshopt_glb("x" + positions.substr(1), indices, "TRIANGLES")), HasSubstr("is damaged"));
}

/// The tetrahedron as Draco data; `method` is draco::MESH_SEQUENTIAL_ENCODING or MESH_EDGEBREAKER_ENCODING.
std::string draco_data(int method, std::size_t& points, int& attribute_id) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(static_cast<int>(k_indices.size() / 3));
    const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::size_t f = 0; f < k_indices.size() / 3; ++f)
        builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(static_cast<std::uint32_t>(f)),
                                          k_corners[k_indices[3 * f]].data(), k_corners[k_indices[3 * f + 1]].data(),
                                          k_corners[k_indices[3 * f + 2]].data());
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    points = mesh->num_points();
    attribute_id = static_cast<int>(mesh->attribute(attribute)->unique_id());
    draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
    return {buffer.data(), buffer.size()};
}

std::string draco_glb(const std::string& data, std::size_t points, int attribute_id, std::size_t corners = 12,
                      const std::string& type = "VEC3") {
    return glb_of(
        json_text("{'asset':{'version':'2.0'},'extensionsRequired':['KHR_draco_mesh_compression'],'nodes':[{'mesh':0}],"
                  "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'extensions':"
                  "{'KHR_draco_mesh_compression':{'bufferView':0,'attributes':{'POSITION':" +
                  std::to_string(attribute_id) +
                  "}}}}]}],'accessors':[{'componentType':5126,'count':" + std::to_string(points) + ",'type':'" + type +
                  "'},{'componentType':5123,'count':" + std::to_string(corners) +
                  ",'type':'SCALAR'}],'bufferViews':[{'buffer':0,'byteLength':" + std::to_string(data.size()) +
                  "}],'buffers':[{'byteLength':" + std::to_string(data.size()) + "}]}"),
        data);
}

TEST(CompressedGltf, DracoPrimitivesAreDecoded) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        std::size_t points = 0;
        int id = 0;
        const std::string data = draco_data(method, points, id);
        EXPECT_EQ(triangles_of(read_as("a.glb", draco_glb(data, points, id)).mesh), expected_triangles());
    }
}

TEST(CompressedGltf, DracoDataThatDoNotFitAreRefused) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        std::size_t points = 0;
        int id = 0;
        const std::string data = draco_data(method, points, id);
        EXPECT_THAT(error_of_glb(draco_glb(data, points, id, 15)), HasSubstr("4 triangles, but its indices have 15"));
        EXPECT_THAT(error_of_glb(draco_glb(data, points + 1, id)), HasSubstr("unlike its accessor"));
        EXPECT_THAT(error_of_glb(draco_glb(data, points, id, 12, "VEC4")), HasSubstr("unlike its accessor"));
        EXPECT_THAT(error_of_glb(draco_glb(data, points, id + 1)), HasSubstr("which its Draco data lack"));
        EXPECT_THAT(error_of_glb(draco_glb("x" + data.substr(1), points, id)), HasSubstr("is no Draco data"));
        for (std::size_t size = 12; size + 1 < data.size(); size += 3)
            error_of_glb(draco_glb(data.substr(0, size), points, id));
        // 200,000,001 faces in a hundred bytes: the number in front of those of the tetrahedron.
        std::string bomb = data;
        const std::size_t at = method == draco::MESH_EDGEBREAKER_ENCODING ? 13 : 11;
        ASSERT_EQ(bomb[at], 4);
        bomb.replace(at, 1, "\x81\x84\xaf\x5f", 4);
        EXPECT_THAT(error_of_glb(draco_glb(bomb, points, id, 600'000'003)), HasSubstr("far more than its bytes can"));
    }
}

/// The tetrahedron with positions of type T, each 4 values of 4 components with the last unused.
template <typename T>
std::string quantized_glb(int component, bool normalized, T one) {
    std::string binary;
    for (const Vec3& corner : k_corners)
        for (int k = 0; k < 4; ++k) binary += bytes_of(static_cast<T>(k < 3 && corner[k] > 0 ? one : T{0}));
    const std::size_t positions = binary.size();
    binary += mesh_files::tetrahedron_indices();
    return glb_of(
        json_text("{'asset':{'version':'2.0'},'extensionsRequired':['KHR_mesh_quantization'],"
                  "'nodes':[{'mesh':0}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
                  "'accessors':[{'bufferView':0,'componentType':" +
                  std::to_string(component) + ",'count':4,'type':'VEC3'" + (normalized ? ",'normalized':true" : "") +
                  "},{'bufferView':1,'componentType':5123,'count':12,'type':'SCALAR'}],"
                  "'bufferViews':[{'buffer':0,'byteLength':" +
                  std::to_string(positions) + ",'byteStride':" + std::to_string(4 * sizeof(T)) +
                  "},{'buffer':0,'byteOffset':" + std::to_string(positions) +
                  ",'byteLength':24}],'buffers':[{'byteLength':" + std::to_string(binary.size()) + "}]}"),
        binary);
}

TEST(CompressedGltf, QuantizedPositionsAreIntegersOrFractions) {
    const auto last = [](const std::string& glb) { return read_as("a.glb", glb).mesh.vertices.at(3); };
    EXPECT_EQ(last(quantized_glb<std::uint8_t>(5121, false, 200)), Vec3(0, 0, 200));
    EXPECT_EQ(last(quantized_glb<std::int16_t>(5122, false, -700)), Vec3(0, 0, -700));
    EXPECT_EQ(last(quantized_glb<std::uint16_t>(5123, false, 60000)), Vec3(0, 0, 60000));
    EXPECT_EQ(last(quantized_glb<std::uint16_t>(5123, true, 65535)), Vec3(0, 0, 1));
    EXPECT_EQ(last(quantized_glb<std::int8_t>(5120, true, 127)), Vec3(0, 0, 1));
    EXPECT_THAT(error_of_glb(quantized_glb<std::uint32_t>(5125, false, 1)), HasSubstr("32-bit integers"));
}

}  // namespace
}  // namespace exemplar
