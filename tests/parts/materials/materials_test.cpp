#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "host/core/errors.h"
#include "host/mesh/io/io.h"
#include "host/parts/materials/part_projection.h"
#include "host/parts/materials/write_materials.h"
#include "tests/parts/rigging/part_shapes.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

std::vector<std::uint32_t> all_faces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> faces(mesh.face_count());
    for (std::uint32_t f = 0; f < faces.size(); ++f) faces[f] = f;
    return faces;
}

TEST(PartProjection, ALimbIsWoundAWholeNumberOfTimes) {
    const TriangleMesh mesh = part_shapes::tube(12);
    const float size = 2 * std::numbers::pi_v<float> / 3;  // three repeats around
    const auto uv = project_part(mesh, all_faces(mesh), Vec3(6, -9, 0), size);
    for (std::size_t f = 0; f < 24 * 32; ++f)  // without the lids
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = mesh.vertices[mesh.faces[f][k]];
            EXPECT_NEAR(std::abs(uv[f][k][1]), std::abs(p.x() - 6) / size, 0.01);
            EXPECT_LT(std::abs(uv[f][k][0] - uv[f][(k + 1) % 3][0]), 0.5F) << "no face crosses the seam";
            const double angle = std::atan2(p.z(), p.y());
            const double turns = 3 * angle / (2 * std::numbers::pi);
            const double off = std::min(std::abs(std::remainder(uv[f][k][0] - turns - 1.5, 3.0)),
                                        std::abs(std::remainder(uv[f][k][0] + turns - 1.5, 3.0)));
            EXPECT_LT(off, 0.02);
        }
}

TEST(PartProjection, APlateIsNotDistorted) {
    const TriangleMesh mesh = shapes::grid(6, 4, 5);
    const auto uv = project_part(mesh, all_faces(mesh), Vec3::Zero(), 2);
    for (std::size_t f = 0; f < uv.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const float edge = (mesh.vertices[mesh.faces[f][k]] - mesh.vertices[mesh.faces[f][(k + 1) % 3]]).norm();
            EXPECT_NEAR((uv[f][k] - uv[f][(k + 1) % 3]).norm(), edge / 2, 1e-4);
        }
}

TEST(PartProjection, TurnsWithTheShape) {
    TriangleMesh mesh = part_shapes::tube(12);
    for (Vec3& v : mesh.vertices) v.y() *= 1 + v.x() / 12;  // no symmetry that leaves an axis open
    for (Vec3& v : mesh.vertices) v.z() *= v.z() > 0 ? 1.3F : 1;
    const Eigen::Matrix3f rotation = shapes::random_rotation(4);
    const auto a = project_part(mesh, all_faces(mesh), Vec3(6, -9, 1), 0.7F);
    const auto b = project_part(shapes::rotated(mesh, rotation), all_faces(mesh), rotation * Vec3(6, -9, 1), 0.7F);
    for (std::size_t f = 0; f < a.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((a[f][k] - b[f][k]).norm(), 0, 0.02) << f;
}

TEST(MaterialTable, ReadsAndRefuses) {
    const TemporaryFolder folder;
    std::ofstream(folder / "skin.json")
        << R"({"arm": {"color": "#ff8000", "metallic": 1, "texture": "x.png", "size": 0.2}, "*": {"roughness": 0}})";
    const MaterialTable table = read_materials(folder / "skin.json");
    EXPECT_EQ(table.at("arm").color, (Color{255, 128, 0}));
    EXPECT_EQ(table.at("arm").texture, folder / "x.png");
    EXPECT_EQ(table.at("*").roughness, 0);
    for (const char* text : {"", "[]", "{}", R"({"a": 1})", R"({"a": {"color": "red"}})", R"({"a": {"metalic": 1}})",
                             R"({"a": {"metallic": 2}})", R"({"a": {"size": 0}})", R"({"a": {"texture": 1}})"}) {
        std::ofstream(folder / "wrong.json") << text;
        EXPECT_THROW(read_materials(folder / "wrong.json"), DataError) << text;
    }
}

TEST(WriteMaterials, LabelsComeBackAsMaterials) {
    const TemporaryFolder folder;
    const TriangleMesh mesh = part_shapes::tube(12);
    const auto label = part_shapes::labels_along_x(mesh, {4, 8});
    const PartGraph graph = build_part_graph(mesh, build_topology(mesh), label);
    write_materials(folder / "tube.glb", mesh, graph, {"a", "b", "c"}, {});
    const MeshFile read = read_mesh(folder / "tube.glb");
    ASSERT_TRUE(read.labels);
    EXPECT_EQ(read.labels->names, (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(read.mesh.face_count(), mesh.face_count());
    EXPECT_EQ(read.mesh.vertex_count(), mesh.vertex_count()) << "seams are welded again";
    std::ofstream(folder / "text.png") << "no picture";
    MaterialTable wrong;
    wrong["a"].texture = folder / "text.png";
    EXPECT_THROW(write_materials(folder / "x.glb", mesh, graph, {"a", "b", "c"}, wrong), DataError);
}

}  // namespace
}  // namespace exemplar
