#include "host/synth/animations/face.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

const Animation& face() {
    static const Animation animation = make_animation("face", {5000, 600, 1, 1});
    return animation;
}

/// The surface with one shape at full weight.
TriangleMesh posed_with(std::size_t target) {
    Pose pose = rest_pose(face().rig);
    pose.weights[target] = 1;
    TriangleMesh mesh = face().rest;
    pose_vertices(face().rig, face().rest.vertices, pose, mesh.vertices);
    return mesh;
}

TEST(Face, HasManyShapesOfDifferentNames) {
    std::set<std::string> names;
    for (const MorphTarget& target : face().rig.targets) names.insert(target.name);
    EXPECT_GE(names.size(), 24u);
    EXPECT_EQ(names.size(), face().rig.targets.size());
    for (const auto* name : {"browInnerUp", "eyeBlinkLeft", "jawOpen", "mouthSmileRight", "cheekPuffLeft"})
        EXPECT_TRUE(names.contains(name)) << name;
}

TEST(Face, ShapesMoveAFewVerticesVisibly) {
    for (const MorphTarget& target : face().rig.targets) {
        SCOPED_TRACE(target.name);
        ASSERT_EQ(target.vertices.size(), target.offsets.size());
        EXPECT_TRUE(std::is_sorted(target.vertices.begin(), target.vertices.end()));
        EXPECT_GT(target.vertices.size(), 20u);
        EXPECT_LT(target.vertices.size(), face().rest.vertex_count() * 3 / 10);
        EXPECT_EQ(target.rest_weight, 0);
        float largest = 0;
        for (const Vec3& offset : target.offsets) {
            EXPECT_GT(offset.norm(), 0);
            largest = std::max(largest, offset.norm());
        }
        EXPECT_GT(largest, 0.012f);
        EXPECT_LT(largest, 0.13f);
    }
}

TEST(Face, ShapesOfASideMoveThatSide) {
    for (const MorphTarget& target : face().rig.targets) {
        const bool is_left = target.name.ends_with("Left"), is_right = target.name.ends_with("Right");
        if ((!is_left && !is_right) || target.name.starts_with("jaw")) continue;
        const auto largest = std::max_element(target.offsets.begin(), target.offsets.end(),
                                              [](const Vec3& a, const Vec3& b) { return a.norm() < b.norm(); });
        const std::uint32_t vertex = target.vertices[static_cast<std::size_t>(largest - target.offsets.begin())];
        const float x = face().rest.vertices[vertex].x();
        if (target.name == "mouthLeft" || target.name == "mouthRight")
            EXPECT_GT(largest->x() * (is_left ? 1.0f : -1.0f), 0.03f) << target.name;
        else
            EXPECT_GT(x * (is_left ? 1.0f : -1.0f), 0.01f) << target.name;
    }
}

TEST(Face, ShapesNeitherFoldNorTearTheSkin) {
    const Topology topology = build_topology(face().rest);
    const std::vector<Vec3> before = face_normals(face().rest);
    for (std::size_t t = 0; t < face().rig.targets.size(); ++t) {
        SCOPED_TRACE(face().rig.targets[t].name);
        const TriangleMesh posed = posed_with(t);
        const std::vector<Vec3> after = face_normals(posed);
        float most_turned = 1, longest = 0;
        for (std::size_t f = 0; f < after.size(); ++f) most_turned = std::min(most_turned, before[f].dot(after[f]));
        for (const Edge& edge : topology.edges) {
            const auto [a, b] = edge.vertex;
            longest = std::max(longest, (posed.vertices[a] - posed.vertices[b]).norm() /
                                            (face().rest.vertices[a] - face().rest.vertices[b]).norm());
        }
        EXPECT_GT(most_turned, 0.2f);
        EXPECT_LT(longest, 2.2f);
    }
}

TEST(Face, ShapesChangeTheCurvature) {
    const VertexCurvature rest = estimate_curvature(face().rest, false);
    for (std::size_t t = 0; t < face().rig.targets.size(); ++t) {
        const VertexCurvature posed = estimate_curvature(posed_with(t), false);
        float change = 0;
        for (const std::uint32_t v : face().rig.targets[t].vertices)
            change = std::max(change, std::abs(posed.k1[v] + posed.k2[v] - rest.k1[v] - rest.k2[v]) / 2);
        EXPECT_GT(change, 1) << face().rig.targets[t].name;  // a tenth of what a fold of a centimeter has
    }
}

TEST(Face, WeightsComeAndGoSmoothlyAFewAtATime) {
    const Clip& clip = face().clips.front();
    std::set<std::size_t> used;
    double active = 0;
    for (std::size_t f = 0; f < clip.size(); ++f) {
        for (std::size_t t = 0; t < clip.poses[f].weights.size(); ++t) {
            const float weight = clip.poses[f].weights[t];
            EXPECT_GE(weight, 0);
            EXPECT_LE(weight, 1);
            if (weight > 0.02f) ++active;
            if (weight > 0.4f) used.insert(t);
            if (f == 0) continue;
            const float before = clip.poses[f - 1].weights[t];
            EXPECT_LT(std::abs(weight - before), 0.35f);
            if (f < 2) continue;
            EXPECT_LT(std::abs(weight - 2 * before + clip.poses[f - 2].weights[t]), 0.12f);
        }
    }
    active /= static_cast<double>(clip.size());
    EXPECT_GT(active, 2);
    EXPECT_LT(active, 0.4 * static_cast<double>(face().rig.targets.size()));
    EXPECT_EQ(used.size(), face().rig.targets.size());  // in 20 seconds every shape is seen
}

}  // namespace
}  // namespace exemplar
