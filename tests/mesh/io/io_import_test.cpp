// Formats that exemplar-import reads; skipped where it was not built.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/mesh/editing/validate.h"
#include "tests/support/import_files.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using import_files::collada;
using import_files::fbx;
using import_files::max_3ds;
using import_files::model_3mf;
using mesh_files::error_of;
using mesh_files::read_as;
using testing::AllOf;
using testing::HasSubstr;

class ReadImported : public import_files::ImportTest {};

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

TEST_F(ReadImported, SkinIsPosedByItsJoints) {
    const MeshFile file = read_as("a.dae", import_files::skinned_collada());
    EXPECT_THAT(file.warnings, testing::IsEmpty());
    EXPECT_THAT(file.polygons.corner_counts, testing::ElementsAre(4, 4));
    // The tip of the strip, at x = 1, is turned by 90 degrees: it moves (x, y) to (1 - y, x - 1). Vertices at x = 0
    // have a fifth of that, those at x = 1 a half, those at x = 2 all.
    const std::vector<Vec3> places{{0.2f, -0.2f, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0.6f, 0}, {0.5f, 0.5f, 0}, {0, 1, 0}};
    ASSERT_EQ(file.mesh.vertex_count(), places.size());
    for (const Vec3& place : places)
        EXPECT_TRUE(std::ranges::any_of(file.mesh.vertices, [&](const Vec3& v) { return (v - place).norm() < 1e-6f; }))
            << place.transpose();
}

TEST_F(ReadImported, MovingNodesAndMorphTargetsAreAtRest) {
    expect_cube(read_as("a.fbx", import_files::turning_fbx()), 6, 0);
    expect_cube(read_as("a.fbx", import_files::morphed_fbx()), 6, 0);
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
