#include "host/synth/animations/animations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/mesh/topology.h"
#include "tests/support/manifold.h"

namespace exemplar {
namespace {

constexpr std::size_t k_vertices = 2500, k_frames = 20;

/// Animations are made once for all tests of this program.
const Animation& animation_of(const std::string& kind, std::uint64_t shape_seed, std::uint64_t motion_seed) {
    static std::map<std::string, Animation> cache;
    const std::string key = kind + std::to_string(shape_seed) + "/" + std::to_string(motion_seed);
    if (!cache.contains(key)) cache[key] = make_animation(kind, {k_vertices, k_frames, shape_seed, motion_seed});
    return cache.at(key);
}

void expect_same_points(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)), 0);
}

void expect_same_surface(const Animation& a, const Animation& b) {
    EXPECT_EQ(a.rest.faces, b.rest.faces);
    expect_same_points(a.rest.vertices, b.rest.vertices);
    EXPECT_EQ(a.rig.influence_begin, b.rig.influence_begin);
    ASSERT_EQ(a.rig.influences.size(), b.rig.influences.size());
    for (std::size_t i = 0; i < a.rig.influences.size(); ++i) {
        EXPECT_EQ(a.rig.influences[i].bone, b.rig.influences[i].bone);
        EXPECT_EQ(a.rig.influences[i].weight, b.rig.influences[i].weight);
    }
    ASSERT_EQ(a.rig.targets.size(), b.rig.targets.size());
    for (std::size_t t = 0; t < a.rig.targets.size(); ++t) {
        EXPECT_EQ(a.rig.targets[t].name, b.rig.targets[t].name);
        EXPECT_EQ(a.rig.targets[t].vertices, b.rig.targets[t].vertices);
        expect_same_points(a.rig.targets[t].offsets, b.rig.targets[t].offsets);
    }
}

/// Largest distance of a vertex between two frames, of the same or of different animations.
float largest_move(const Animation& a, std::size_t frame_a, const Animation& b, std::size_t frame_b) {
    const std::vector<Vec3> from = frame_vertices(a, a.clips.front(), frame_a);
    const std::vector<Vec3> to = frame_vertices(b, b.clips.front(), frame_b);
    float largest = 0;
    for (std::size_t v = 0; v < from.size(); ++v) largest = std::max(largest, (to[v] - from[v]).norm());
    return largest;
}

class AnimationsOfKind : public testing::TestWithParam<std::string> {};

TEST_P(AnimationsOfKind, HaveOneNamedClipOfTheFramesAskedFor) {
    const Animation& animation = animation_of(GetParam(), 1, 2);
    EXPECT_EQ(animation.name, GetParam());
    ASSERT_EQ(animation.clips.size(), 1u);
    EXPECT_EQ(animation.clips.front().name, "motion_2");
    EXPECT_EQ(animation.clips.front().size(), k_frames);
    EXPECT_EQ(animation.clips.front().frames_per_second, 30);
    EXPECT_TRUE(animation.warnings.empty());
}

TEST_P(AnimationsOfKind, FitTheirOwnParts) {
    const Animation& animation = animation_of(GetParam(), 1, 1);
    const Clip& clip = animation.clips.front();
    const bool is_rigged = animation.kind != AnimationKind::sequence;
    EXPECT_EQ(clip.poses.size(), is_rigged ? k_frames : 0);
    EXPECT_EQ(clip.frames.size(), is_rigged ? 0 : k_frames);
    EXPECT_EQ(animation.rig.nodes.empty(), !is_rigged);
    EXPECT_EQ(animation.rig.bones.empty(), !is_rigged);
    EXPECT_EQ(animation.rig.targets.empty(), animation.kind != AnimationKind::blend_shapes);
    std::vector<std::uint32_t> identity(animation.rest.vertex_count());
    std::iota(identity.begin(), identity.end(), 0U);
    EXPECT_EQ(animation.vertex_of_source, identity);
    EXPECT_EQ(animation.rest.source_face_count, animation.rest.face_count());
    for (const Pose& pose : clip.poses) {
        EXPECT_EQ(pose.nodes.size(), animation.rig.nodes.size());
        EXPECT_EQ(pose.weights.size(), animation.rig.targets.size());
    }
}

TEST_P(AnimationsOfKind, MeetTheVertexCount) {
    for (const std::size_t vertices : {std::size_t{1000}, k_vertices}) {
        const Animation animation = make_animation(GetParam(), {vertices, 1, 1, 1});
        EXPECT_NEAR(static_cast<double>(animation.rest.vertex_count()), static_cast<double>(vertices),
                    0.05 * static_cast<double>(vertices));
    }
}

TEST_P(AnimationsOfKind, AreManifoldAndOrientedAtRest) {
    const TriangleMesh& mesh = animation_of(GetParam(), 1, 1).rest;
    EXPECT_THAT(face_components(mesh, build_topology(mesh)), testing::Each(0u));
    EXPECT_THAT(face_areas(mesh), testing::Each(testing::Gt(0.0f)));
    if (animation_of(GetParam(), 1, 1).kind == AnimationKind::sequence) return;
    EXPECT_TRUE(is_closed_and_oriented(mesh));
    EXPECT_TRUE(is_vertex_manifold(mesh));
    EXPECT_GT(signed_volume(mesh), 0);
    EXPECT_EQ(mesh.face_count(), 2 * (mesh.vertex_count() - 2));  // no handles: nothing has grown together
}

TEST_P(AnimationsOfKind, HaveNoFoldedFacesAtRest) {
    const TriangleMesh& mesh = animation_of(GetParam(), 1, 1).rest;
    const std::vector<Vec3> normals = face_normals(mesh);
    for (const Edge& edge : build_topology(mesh).edges) {
        if (edge.is_boundary()) continue;
        EXPECT_GT(normals[edge.face[0]].dot(normals[edge.face[1]]), -0.3f);
    }
}

TEST_P(AnimationsOfKind, AreTheSameBytesForTheSameSeedsOnAnyNumberOfThreads) {
    const ThreadLimit one(1);
    const Animation again = make_animation(GetParam(), {k_vertices, k_frames, 1, 1});
    const Animation& first = animation_of(GetParam(), 1, 1);
    expect_same_surface(again, first);
    for (std::size_t f = 0; f < k_frames; ++f)
        expect_same_points(frame_vertices(again, again.clips.front(), f),
                           frame_vertices(first, first.clips.front(), f));
}

TEST_P(AnimationsOfKind, KeepTheSurfaceWhenOnlyTheMotionSeedChanges) {
    const Animation &a = animation_of(GetParam(), 1, 1), &b = animation_of(GetParam(), 1, 2);
    expect_same_surface(a, b);
    EXPECT_GT(largest_move(a, k_frames - 1, b, k_frames - 1), 1e-2f);
}

TEST_P(AnimationsOfKind, HaveAnotherSurfaceForAnotherShapeSeed) {
    EXPECT_NE(animation_of(GetParam(), 1, 1).rest.vertices, animation_of(GetParam(), 2, 1).rest.vertices);
}

TEST_P(AnimationsOfKind, Move) {
    const Animation& animation = animation_of(GetParam(), 1, 1);
    EXPECT_GT(largest_move(animation, 0, animation, k_frames - 1), 1e-2f);
}

INSTANTIATE_TEST_SUITE_P(Kinds, AnimationsOfKind,
                         testing::ValuesIn(std::vector<std::string>(synth_animation_kinds().begin(),
                                                                    synth_animation_kinds().end())),
                         [](const auto& kind) { return kind.param; });

TEST(Animations, UnknownKindIsAUsageErrorWithASuggestion) {
    try {
        make_animation("figur");
        FAIL() << "no error";
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'figure'"));
    }
    EXPECT_THROW(make_animation(""), UsageError);
}

TEST(Animations, AbsurdCountsAreUsageErrors) {
    for (const std::size_t vertices : {std::size_t{0}, std::size_t{499}, std::size_t{1} << 20})
        EXPECT_THROW(make_animation("figure", {vertices, 10, 1, 1}), UsageError) << vertices;
    EXPECT_THROW(make_animation("figure", {1000, 0, 1, 1}), UsageError);
    EXPECT_THROW(make_animation("figure", {1000, ~std::size_t{0}, 1, 1}), UsageError);
}

}  // namespace
}  // namespace exemplar
