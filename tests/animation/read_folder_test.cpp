#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/animation/read_animation.h"
#include "host/core/errors.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A tetrahedron as OBJ, whose last vertex is at height `z`.
std::string obj(float z, const std::string& faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n") {
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 " + std::to_string(z) + "\n" + faces;
}

class Folder : public testing::Test {
  protected:
    void add(const std::string& name, const std::string& bytes) { mesh_files::write_bytes(folder_ / name, bytes); }
    Animation read(const ReadAnimationOptions& options = {}) { return read_animation(folder_.path(), options); }
    std::string error() {
        std::string message = mesh_files::error_of<MeshError>([&] { std::ignore = read(); });
        EXPECT_THAT(message, HasSubstr(folder_.path().string()));
        return message;
    }
    /// The height of vertex 3 in each frame.
    std::vector<float> heights() {
        const Animation animation = read();
        std::vector<float> z;
        for (const std::vector<Vec3>& frame : animation.clips.at(0).frames) z.push_back(frame.at(3)[2]);
        return z;
    }

    mesh_files::TemporaryFolder folder_;
};

TEST_F(Folder, FramesAreInNaturalOrder) {
    for (const int i : {10, 9, 2, 1}) add("frame" + std::to_string(i) + ".obj", obj(static_cast<float>(i)));
    EXPECT_THAT(heights(), ElementsAre(1, 2, 9, 10));
    const Animation animation = read({.frames_per_second = 24});
    EXPECT_EQ(animation.kind, AnimationKind::sequence);
    EXPECT_EQ(animation.clips.at(0).name, folder_.path().filename().string());
    EXPECT_EQ(animation.clips[0].frames_per_second, 24);
    EXPECT_EQ(animation.rest.vertices, animation.clips[0].frames[0]);
    EXPECT_THAT(animation.rest.faces, SizeIs(4));
    EXPECT_THAT(animation.rig.bones, IsEmpty());
    EXPECT_THAT(animation.warnings, IsEmpty());
}

TEST_F(Folder, AHyphenIsAMinusBesideNumbersWithoutOne) {
    for (const int i : {-10, -2, -1, 0, 1}) add("walk" + std::to_string(i) + ".obj", obj(static_cast<float>(i)));
    EXPECT_THAT(heights(), ElementsAre(-10, -2, -1, 0, 1));
}

TEST_F(Folder, AHyphenIsNoMinusIfAllNumbersHaveIt) {
    for (const int i : {1, 2, 10}) add("walk-" + std::to_string(i) + ".obj", obj(static_cast<float>(i)));
    EXPECT_THAT(heights(), ElementsAre(1, 2, 10));
}

TEST_F(Folder, TheRestShapeIsNoFrame) {
    add("Rest.obj", obj(7));
    add("0.obj", obj(1));
    add("1.obj", obj(2));
    EXPECT_THAT(heights(), ElementsAre(1, 2));
    EXPECT_EQ(read().rest.vertices[3], Vec3(0, 0, 7));
}

TEST_F(Folder, OtherFilesAndHiddenOnesDoNotMatter) {
    add("0.obj", obj(1));
    add("README.md", "text");
    add("._0.obj", "no mesh");
    std::filesystem::create_directory(folder_ / "1.obj");
    EXPECT_THAT(heights(), ElementsAre(1));
}

TEST_F(Folder, AnotherTopologyIsRefusedByNameAndDifference) {
    add("0.obj", obj(1));
    add("1.obj", obj(1, "f 1 3 2\nf 1 2 4\nf 1 4 2\nf 2 3 4\n"));
    add("2.obj", obj(1) + "v 1 1 1\n");
    EXPECT_THAT(error(), AllOf(HasSubstr("1.obj: has other corners in face 2"), HasSubstr("unlike 0.obj")));
    add("1.obj", obj(1, "f 1 3 2\n"));
    EXPECT_THAT(error(), HasSubstr("1.obj: has 1 faces instead of 4"));
    add("1.obj", obj(1));
    EXPECT_THAT(error(), HasSubstr("2.obj: has 5 vertices instead of 4"));
    add("2.obj", "v 1 2\n");
    EXPECT_THAT(error(), HasSubstr("2.obj:1: "));
}

TEST_F(Folder, PolygonsThatAreCutAnotherWayAreOfOneTopology) {
    const auto quad = [](float x) { return "v 0 0 0\nv 4 0 0\nv " + std::to_string(x) + " 1 0\nv 0 4 0\nf 1 2 3 4\n"; };
    add("0.obj", quad(4));  // convex
    add("1.obj", quad(1));  // not convex at its third corner
    const Animation animation = read();
    EXPECT_THAT(animation.rest.faces, SizeIs(2));
    EXPECT_EQ(animation.rest.source_face_count, 1u);
    EXPECT_THAT(animation.clips.at(0).frames, SizeIs(2));
}

TEST_F(Folder, SeamsAreWeldedOnlyIfTheyNeverOpen) {
    // Two triangles with two pairs of coincident vertices: (1, 3) and (2, 4).
    const auto strip = [](const std::string& fourth) {
        return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv " + fourth + "\nv 1 1 0\nf 1 2 3\nf 5 4 6\n";
    };
    add("0.obj", strip("0 1 0"));
    add("1.obj", strip("0 1 0"));
    const Animation closed = read();
    EXPECT_THAT(closed.vertex_of_source, ElementsAre(0, 1, 2, 1, 2, 3));
    EXPECT_THAT(closed.rest.faces, ElementsAre(Face{0, 1, 2}, Face{2, 1, 3}));
    EXPECT_THAT(closed.clips.at(0).frames[1], SizeIs(4));
    add("2.obj", strip("0 1 1"));
    const Animation torn = read();
    EXPECT_THAT(torn.vertex_of_source, ElementsAre(0, 1, 2, 1, 3, 4));
    EXPECT_EQ(torn.clips.at(0).frames[2][3], Vec3(0, 1, 1));
    EXPECT_EQ(torn.rest.vertices[3], Vec3(0, 1, 0));
}

TEST_F(Folder, FormatsMustNotBeMixed) {
    add("0.obj", obj(1));
    add("1.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    EXPECT_THAT(error(), AllOf(HasSubstr("0.obj and 1.off"), HasSubstr("different formats")));
}

TEST_F(Folder, FoldersWithoutFramesAndFilesOfOneShapeAreRefused) {
    EXPECT_THAT(error(), HasSubstr("holds no meshes"));
    add("rest.obj", obj(1));
    EXPECT_THAT(error(), HasSubstr("holds no meshes"));
    add("REST.obj", obj(1));
    EXPECT_THAT(error(), HasSubstr("stand for the same"));
    EXPECT_THAT(mesh_files::error_of<MeshError>([&] { std::ignore = read_animation(folder_ / "rest.obj"); }),
                HasSubstr("name the folder that holds the frames"));
    EXPECT_THAT(mesh_files::error_of<MeshError>([&] { std::ignore = read_animation(folder_ / "none.glb"); }),
                HasSubstr("none.glb"));
}

TEST_F(Folder, BrokenFramesAreDroppedAndDoNotBecomeTheRestShape) {
    const std::string broken = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 nan\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    add("0.obj", broken);
    add("1.obj", obj(1));
    add("2.obj", obj(2));
    const Animation animation = read();
    EXPECT_THAT(animation.warnings, ElementsAre(HasSubstr("frames 0 are not finite")));
    EXPECT_EQ(animation.rest.vertices[3], Vec3(0, 0, 1));
    EXPECT_THAT(heights(), ElementsAre(1, 2));
    add("rest.obj", broken);
    EXPECT_THAT(error(), HasSubstr("vertex 3 of the rest shape is not finite"));
}

TEST_F(Folder, AMotionThatStandsStillIsRemarked) {
    for (const char* name : {"0.obj", "1.obj", "2.obj"}) add(name, obj(1));
    EXPECT_THAT(read().warnings, ElementsAre(HasSubstr("never moves")));
    add("2.obj", obj(1.001f));
    EXPECT_THAT(read().warnings, IsEmpty());
}

TEST_F(Folder, ANeutralMeshMakesTheOthersBlendShapes) {
    add("NEUTRAL.obj", obj(1));
    add("smile.obj", obj(3));
    add("none.obj", obj(1));
    const Animation animation = read();
    EXPECT_EQ(animation.kind, AnimationKind::blend_shapes);
    EXPECT_THAT(animation.clips, IsEmpty());
    ASSERT_THAT(animation.rig.targets, SizeIs(2));
    EXPECT_EQ(animation.rig.targets[0].name, "none");
    EXPECT_THAT(animation.rig.targets[0].vertices, IsEmpty());
    EXPECT_EQ(animation.rig.targets[1].name, "smile");
    EXPECT_THAT(animation.rig.targets[1].vertices, ElementsAre(3));
    EXPECT_THAT(animation.rig.targets[1].offsets, ElementsAre(Vec3(0, 0, 2)));
    Pose pose = rest_pose(animation.rig);
    pose.weights[1] = 0.5f;
    std::vector<Vec3> posed;
    pose_vertices(animation.rig, animation.rest.vertices, pose, posed);
    EXPECT_EQ(posed[3], Vec3(0, 0, 2));
    EXPECT_EQ(posed[1], Vec3(1, 0, 0));
}

TEST_F(Folder, FramesFarFromTheOriginAreInOneFrameOfReference) {
    const auto tetrahedron = [](double x) {  // moves 2 units a frame, and shrinks
        const double y = 4581234.1, s = x < 431235 ? 1 : 0.25;
        return fmt::format("v {} {} 1\nv {} {} 1\nv {} {} 1\nv {} {} {}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", x, y,
                           x + s, y, x, y + s, x, y, 1 + s);
    };
    for (const int i : {1, 2, 3}) add(fmt::format("{}.obj", i), tetrahedron(431231.03 + 2 * i));
    const Animation animation = read();
    const std::vector<std::vector<Vec3>>& frames = animation.clips.at(0).frames;
    for (std::size_t i = 0; i < 3; ++i) {
        const double x = 431231.03 + 2 * static_cast<double>(i + 1), s = x < 431235 ? 1 : 0.25;
        const Vec3d at = animation.rest.origin + frames[i][0].cast<double>(),
                    tip = (frames[i][1] - frames[i][0]).cast<double>();
        EXPECT_LT((at - Vec3d(x, 4581234.1, 1)).norm(), 1e-6) << i;
        EXPECT_NEAR(tip[0], s, 1e-6) << i;
    }
}

TEST_F(Folder, FramesThatAreTooLargeAreRefused) {
    add("1.obj", "v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n");
    EXPECT_THAT(error(), HasSubstr("too large"));
}

}  // namespace
}  // namespace exemplar
