#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "host/animation/read_animation.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct Expected {
    const char* path;
    AnimationKind kind;
    std::size_t source_vertices, vertices, faces, joints, targets, clips, frames;
};

/// Vertices of the files, joints, targets and frames are those that their makers state.
constexpr Expected k_expected[] = {
    {"skinned/CesiumMan.glb", AnimationKind::skeleton, 3273, 2338, 4672, 19, 0, 1, 61},
    {"skinned/Fox.glb", AnimationKind::skeleton, 1728, 290, 576, 24, 0, 3, 160},
    {"skinned/Xbot.glb", AnimationKind::skeleton, 28374, 24746, 49112, 67, 0, 7, 268},
    {"faces/facecap_plain.glb", AnimationKind::blend_shapes, 4368, 4237, 8042, 4, 52, 1, 336},
    {"faces/arkit", AnimationKind::blend_shapes, 1220, 1220, 2304, 1, 51, 0, 0},
    {"sequences/samba", AnimationKind::sequence, 9971, 9971, 19938, 0, 0, 1, 175},
    {"sequences/horse-gallop", AnimationKind::sequence, 8431, 8431, 16843, 0, 0, 1, 48},
    {"sequences/horse-collapse", AnimationKind::sequence, 8431, 8431, 16843, 0, 0, 1, 53},
    {"sequences/pcow", AnimationKind::sequence, 2904, 2903, 5804, 0, 0, 1, 204},
    {"sequences/flag", AnimationKind::sequence, 6305, 6305, 12288, 0, 0, 1, 51},
};

void expect_not_collapsed(const Animation& animation) {
    std::vector<Vec3> shape;
    if (animation.clips.empty())
        pose_vertices(animation.rig, animation.rest.vertices, rest_pose(animation.rig), shape);
    else
        shape = frame_vertices(animation, animation.clips.front(), 0);
    TriangleMesh mesh = animation.rest;
    mesh.vertices = shape;
    const std::vector<float> areas = face_areas(mesh);
    double area = 0;
    for (const float a : areas) area += a;
    const double diagonal = bounding_box(mesh).diagonal();
    EXPECT_TRUE(std::isfinite(diagonal));
    EXPECT_GT(area, 0.1 * diagonal * diagonal);
}

TEST(SlowRealAnimations, HaveTheirCountsAndAFirstFrame) {
    const char* const data = std::getenv("EXEMPLAR_DATA");
    if (data == nullptr || *data == 0 || !fs::is_directory(fs::path(data) / "anim"))
        GTEST_SKIP() << "set EXEMPLAR_DATA to a folder that holds anim/ (docs/testing.md)";
    for (const Expected& expected : k_expected) {
        SCOPED_TRACE(expected.path);
        const Animation animation = read_animation(fs::path(data) / "anim" / expected.path);
        EXPECT_EQ(animation.kind, expected.kind);
        EXPECT_EQ(animation.vertex_of_source.size(), expected.source_vertices);
        EXPECT_EQ(animation.rest.vertex_count(), expected.vertices);
        EXPECT_EQ(animation.rest.face_count(), expected.faces);
        EXPECT_EQ(animation.rig.bones.size(), expected.joints);
        EXPECT_EQ(animation.rig.targets.size(), expected.targets);
        EXPECT_EQ(animation.clips.size(), expected.clips);
        EXPECT_EQ(animation.frame_count(), expected.frames);
        expect_not_collapsed(animation);
    }
}

}  // namespace
}  // namespace exemplar
