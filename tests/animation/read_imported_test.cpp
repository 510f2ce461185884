// Animations that exemplar-import reads; skipped where it was not built.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/animation/read_animation.h"
#include "host/animation/read_formats.h"
#include "host/animation/read_surface.h"
#include "tests/support/import_files.h"

namespace exemplar {
namespace {

using mesh_files::error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ReadImportedAnimation : public import_files::ImportTest {
  protected:
    Animation read(const std::string& name, const std::string& bytes) const {
        mesh_files::write_bytes(folder_ / name, bytes);
        return read_animation(folder_ / name);
    }
    SurfaceFile surface(const std::string& name, const std::string& bytes) const {
        mesh_files::write_bytes(folder_ / name, bytes);
        return read_surface(folder_ / name);
    }

  private:
    TemporaryFolder folder_;
};

/// Whether both hold the same places, in any order.
void expect_strip_or_cube(const std::vector<Vec3>& vertices, const std::vector<Vec3>& expected) {
    ASSERT_EQ(vertices.size(), expected.size());
    for (const Vec3& place : expected) {
        float nearest = 1e9f;
        for (const Vec3& vertex : vertices) nearest = std::min(nearest, (vertex - place).norm());
        EXPECT_LT(nearest, 1e-6f) << place.transpose();
    }
}

std::vector<Vec3> at_rest(const Animation& animation) {
    std::vector<Vec3> vertices;
    pose_vertices(animation.rig, animation.rest.vertices, rest_pose(animation.rig), vertices);
    return vertices;
}

/// The strip of skinned_collada() while its tip is turned by an angle: a vertex (0, y) has 4/5 of the root's and 1/5 of
/// the tip's place, (1, y) the middle of both, (2, y) the tip's place.
std::vector<Vec3> strip_at(double degrees) {
    const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
    std::vector<Vec3> places;
    for (const double x : {0.0, 1.0, 2.0})
        for (const double y : {0.0, 1.0}) {
            const Vec3d turned(1 + c * (x - 1) - s * y, s * (x - 1) + c * y, 0);
            const double share = x == 0 ? 0.2 : x / 2;
            places.push_back(((1 - share) * Vec3d(x, y, 0) + share * turned).cast<float>());
        }
    return places;
}

TEST_F(ReadImportedAnimation, SkinOfColladaIsPosedByItsJoints) {
    const Animation animation = read("a.dae", import_files::skinned_collada());
    EXPECT_EQ(animation.kind, AnimationKind::skeleton);
    EXPECT_THAT(animation.warnings, IsEmpty());
    EXPECT_EQ(animation.rig.bones.size(), 5U);
    expect_strip_or_cube(at_rest(animation), strip_at(90));
    ASSERT_EQ(animation.clips.size(), 1U);
    ASSERT_EQ(animation.clips[0].size(), 31U);
    expect_strip_or_cube(frame_vertices(animation, animation.clips[0], 0), strip_at(90));
    expect_strip_or_cube(frame_vertices(animation, animation.clips[0], 15), strip_at(45));
    expect_strip_or_cube(frame_vertices(animation, animation.clips[0], 30), strip_at(0));
}

TEST_F(ReadImportedAnimation, NodeOfFbxTurnsAboutItsPivot) {
    const Animation animation = read("a.fbx", import_files::turning_fbx());
    EXPECT_EQ(animation.kind, AnimationKind::sequence);
    EXPECT_THAT(animation.warnings, IsEmpty());
    ASSERT_EQ(animation.clips.size(), 1U);
    ASSERT_EQ(animation.clips[0].size(), 31U);
    for (const std::size_t frame : {0U, 10U, 15U, 30U}) {
        const double angle = static_cast<double>(frame) * M_PI / 60, c = std::cos(angle), s = std::sin(angle);
        std::vector<Vec3> expected;
        for (const double x : {0.0, 1.0})
            for (const double y : {0.0, 1.0})
                for (const double z : {0.0, 1.0})
                    expected.push_back(Vec3d(1 + c * (x - 1) - s * y, s * (x - 1) + c * y, z).cast<float>());
        expect_strip_or_cube(frame_vertices(animation, animation.clips[0], frame), expected);
    }
}

TEST_F(ReadImportedAnimation, MorphTargetOfFbxStartsAtZero) {
    const Animation animation = read("a.fbx", import_files::morphed_fbx());
    EXPECT_EQ(animation.kind, AnimationKind::blend_shapes);
    ASSERT_EQ(animation.rig.targets.size(), 1U);
    EXPECT_EQ(animation.rig.targets[0].name, "up");
    EXPECT_EQ(animation.rig.targets[0].rest_weight, 0.0f);
    EXPECT_THAT(animation.rig.targets[0].offsets, ElementsAre(Vec3(0, 0, 2)));
    ASSERT_EQ(animation.clips.size(), 1U);
    ASSERT_EQ(animation.clips[0].size(), 31U);
    EXPECT_THAT(animation.clips[0].poses[15].weights, ElementsAre(testing::FloatNear(0.25f, 1e-6f)));
    EXPECT_THAT(animation.clips[0].poses[30].weights, ElementsAre(0.5f));
}

TEST_F(ReadImportedAnimation, StillFilesAreShownAsStills) {
    const SurfaceFile still = surface("a.dae", import_files::collada(false));
    EXPECT_FALSE(still.animation.moves());
    EXPECT_THAT(still.animation.warnings, IsEmpty());
    EXPECT_THAT(still.why_still, HasSubstr("a.dae: there is neither a skin"));
    EXPECT_THROW(read("a.3ds", import_files::max_3ds()), NoMotionError);
    EXPECT_TRUE(surface("a.fbx", import_files::turning_fbx()).animation.moves());
}

TEST_F(ReadImportedAnimation, BadFilesAreRefusedInOneLine) {
    const auto error = [&](const std::string& name, const std::string& bytes) {
        return error_of<MeshError>([&] { read(name, bytes); });
    };
    EXPECT_THAT(error("a.dae", "<COLLADA"), HasSubstr("a.dae: cannot be read"));
    EXPECT_THAT(error("a.fbx", "FBX"), HasSubstr("a.fbx: cannot be read"));
}

/// A file may have taken control of exemplar-import, which then writes anything.
TEST(ImportedOutput, IsTrustedNoMoreThanAFile) {
    const auto error = [](const std::string& output) {
        return error_of<MeshError>([&] { animation_io::animation_of_import(output, "a.fbx", {}); });
    };
    EXPECT_THAT(error(""), HasSubstr("a.fbx: there is neither"));
    EXPECT_THAT(error("warning a skin\n"), HasSubstr("a.fbx: there is neither"));
    EXPECT_THAT(error("ply\n"), HasSubstr("a.fbx: exemplar-import wrote no scene"));
    EXPECT_THAT(error("warning without an end"), HasSubstr("a.fbx: "));
    EXPECT_THAT(error("glTF\2"), HasSubstr("a.fbx: "));
    const std::string beside = mesh_files::tetrahedron_gltf("'uri':'a.bin',");
    EXPECT_THAT(error(mesh_files::glb_of(beside, "")), HasSubstr("a.fbx: buffer 0"));
}

}  // namespace
}  // namespace exemplar
