// Formats that exemplar-import reads; skipped where it was not built.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/mesh/editing/validate.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::error_of;
using mesh_files::read_as;
using testing::AllOf;
using testing::HasSubstr;

class ReadImported : public testing::Test {
  protected:
    void SetUp() override {
        const auto program =
            std::filesystem::read_symlink("/proc/self/exe").parent_path().parent_path() / "exemplar-import";
        if (!std::filesystem::exists(program)) GTEST_SKIP() << "exemplar-import is not built; it needs libassimp-dev";
    }
};

/// A cube of six quads, as a list of corners each; it looks outward.
struct Cube {
    std::vector<float> coordinates;
    std::vector<int> corners{0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    Cube() {
        for (int v = 0; v < 8; ++v)
            for (int axis = 0; axis < 3; ++axis) coordinates.push_back(static_cast<float>(v >> axis & 1));
    }
};

/// COLLADA, at x + 5 and, if `mirrored`, with x turned around.
std::string collada(bool mirrored) {
    const Cube cube;
    return fmt::format(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
        "<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
        "<float_array id=\"a\" count=\"24\">{}</float_array><technique_common><accessor source=\"#a\" count=\"8\" "
        "stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
        "type=\"float\"/>"
        "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
        "source=\"#p\"/></vertices>"
        "<polylist count=\"6\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>4 4 4 4 4 "
        "4</vcount><p>{}</p>"
        "</polylist></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node "
        "id=\"n\">"
        "<matrix>{} 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url=\"#g\"/></node></visual_scene>"
        "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
        fmt::join(cube.coordinates, " "), fmt::join(cube.corners, " "), mirrored ? -1 : 1);
}

std::string fbx() {
    const Cube cube;
    std::vector<int> corners = cube.corners;
    for (std::size_t i = 3; i < corners.size(); i += 4) corners[i] = -corners[i] - 1;  // the last of a polygon
    return fmt::format(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}}\nObjects: "
        " {{\n"
        "\tGeometry: 1, \"Geometry::cube\", \"Mesh\" {{\n\t\tVertices: *24 {{\n\t\t\ta: {}\n\t\t}}\n"
        "\t\tPolygonVertexIndex: *24 {{\n\t\t\ta: {}\n\t\t}}\n\t\tGeometryVersion: 124\n\t}}\n"
        "\tModel: 2, \"Model::cube\", \"Mesh\" {{\n\t\tVersion: 232\n\t}}\n}}\n"
        "Connections:  {{\n\tC: \"OO\",2,0\n\tC: \"OO\",1,2\n}}\n",
        fmt::join(cube.coordinates, ","), fmt::join(corners, ","));
}

std::string chunk_3ds(std::uint16_t kind, const std::string& content) {
    return bytes_of(kind) + bytes_of(static_cast<std::uint32_t>(content.size() + 6)) + content;
}
std::string max_3ds() {
    const Cube cube;
    std::string vertices = bytes_of(std::uint16_t{8}), faces = bytes_of(std::uint16_t{12});
    for (const float x : cube.coordinates) vertices += bytes_of(x);
    for (std::size_t i = 0; i < 24; i += 4)
        for (std::size_t k = 1; k < 3; ++k) {
            for (const std::size_t corner : {i, i + k, i + k + 1})
                faces += bytes_of(static_cast<std::uint16_t>(cube.corners[corner]));
            faces += bytes_of(std::uint16_t{7});
        }
    const std::string mesh = chunk_3ds(0x4100, chunk_3ds(0x4110, vertices) + chunk_3ds(0x4120, faces));
    return chunk_3ds(0x4d4d, chunk_3ds(0x0002, bytes_of(std::uint32_t{3})) +
                                 chunk_3ds(0x3d3d, chunk_3ds(0x4000, std::string("cube\0", 5) + mesh)));
}

std::uint32_t crc32_of(const std::string& bytes) {
    std::uint32_t crc = ~0U;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0U);
    }
    return ~crc;
}

/// A ZIP archive of files that are not compressed.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
    std::string bytes, directory;
    for (const auto& [name, content] : files) {
        const auto size = static_cast<std::uint32_t>(content.size());
        const std::string about = bytes_of(std::uint16_t{20}) + std::string(8, '\0') + bytes_of(crc32_of(content)) +
                                  bytes_of(size) + bytes_of(size) + bytes_of(static_cast<std::uint16_t>(name.size())) +
                                  std::string(2, '\0');
        directory
            .append("PK\1\2" + bytes_of(std::uint16_t{20}) + about + std::string(10, '\0') +
                    bytes_of(static_cast<std::uint32_t>(bytes.size())))
            .append(name);
        bytes.append("PK\3\4").append(about).append(name).append(content);
    }
    const auto count = bytes_of(static_cast<std::uint16_t>(files.size()));
    return bytes + directory + "PK\5\6" + std::string(4, '\0') + count + count +
           bytes_of(static_cast<std::uint32_t>(directory.size())) + bytes_of(static_cast<std::uint32_t>(bytes.size())) +
           std::string(2, '\0');
}

std::string model_3mf() {
    const Cube cube;
    std::string vertices, triangles;
    for (std::size_t v = 0; v < 24; v += 3)
        vertices += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", cube.coordinates[v], cube.coordinates[v + 1],
                                cube.coordinates[v + 2]);
    for (std::size_t i = 0; i < 24; i += 4)
        for (std::size_t k = 1; k < 3; ++k)
            triangles += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", cube.corners[i], cube.corners[i + k],
                                     cube.corners[i + k + 1]);
    const std::string place = "http://schemas.openxmlformats.org/package/2006/";
    return zip_of(
        {{"[Content_Types].xml",
          "<Types xmlns=\"" + place +
              "content-types\"><Default Extension=\"model\" "
              "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
         {"_rels/.rels",
          "<Relationships xmlns=\"" + place +
              "relationships\"><Relationship Target=\"/3D/3dmodel.model\" "
              "Id=\"r\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
         {"3D/3dmodel.model",
          "<?xml version=\"1.0\"?><model unit=\"millimeter\" "
          "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources><object id=\"1\" "
          "type=\"model\"><mesh><vertices>" +
              vertices + "</vertices><triangles>" + triangles +
              "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>"}});
}

/// The cube is closed, looks outward, and lies where the file says.
void expect_cube(const MeshFile& file, std::size_t polygons, double low_x) {
    EXPECT_EQ(file.mesh.vertex_count(), 8U);
    EXPECT_EQ(file.mesh.source_face_count, polygons);
    EXPECT_TRUE(validate_mesh(file.mesh).clean());
    EXPECT_EQ(validate_mesh(file.mesh).boundary_edges, 0U);
    EXPECT_THAT(file.warnings, testing::IsEmpty());
    const BoundingBox box = bounding_box(file.mesh);
    EXPECT_NEAR(box.low[0], low_x, 1e-6);
    EXPECT_LT((box.high - box.low - Vec3d::Ones()).norm(), 1e-6);
}

TEST_F(ReadImported, EveryFormatGivesTheCube) {
    expect_cube(read_as("a.dae", collada(false)), 6, 5);
    expect_cube(read_as("a.dae", collada(true)), 6, 4);
    expect_cube(read_as("a.fbx", fbx()), 6, 0);
    expect_cube(read_as("A.3DS", max_3ds()), 12, 0);
    expect_cube(read_as("a.3mf", model_3mf()), 12, 0);
}

TEST_F(ReadImported, BadFilesAreRefusedInOneLine) {
    const auto error = [](const std::string& name, const std::string& bytes) {
        std::string message = error_of<MeshError>([&] { read_as(name, bytes); });
        EXPECT_THAT(message, AllOf(HasSubstr(name + ": "), testing::Not(HasSubstr("\n"))));
        return message;
    };
    EXPECT_THAT(error("a.dae", "<COLLADA"), HasSubstr("XML"));
    error("a.fbx", std::string("Kaydara FBX Binary  \0\x1a\0", 23) + std::string(200, '\7'));
    error("a.3ds", "MM\xff\xff\xff\x7f");
    error("a.3mf", "PK\3\4xx");
    const std::string dae = collada(false), fbx_file = fbx(), max_file = max_3ds();
    for (std::size_t part = 1; part < 8; ++part) {  // cut off: refused, or read as far as it goes
        for (const auto& [name, bytes] :
             {std::pair("a.dae", dae), std::pair("a.fbx", fbx_file), std::pair("a.3ds", max_file)})
            try {
                read_as(name, bytes.substr(0, bytes.size() * part / 8));
            } catch (const MeshError& refused) {
                EXPECT_THAT(refused.what(), HasSubstr(name));
            }
    }
}

}  // namespace
}  // namespace exemplar
