#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "host/core/random.h"
#include "host/curvature/state/attributes.h"
#include "host/mesh/curvature/tangent_tensors.h"

namespace exemplar {
namespace {

Vec3 random_unit(Random& random) {
    return Vec3(float(random.normal()), float(random.normal()), float(random.normal())).normalized();
}

/// Vertices with random curvature in two segments with random rotations; normals near the reference normals. Each
/// vertex has a neighbor of its own, behind all of them.
struct AttributeScene {
    AttributeFrames frames;
    std::vector<Vec3> vertices, normals;
    std::vector<Eigen::Matrix3f> rotations;
    VertexCurvature curvature;

    PosedSurface surface() const { return {vertices, normals, rotations}; }
};

AttributeScene random_attribute_scene(AttributeSet set, std::size_t count, std::uint64_t seed) {
    Random random(seed);
    AttributeScene scene;
    scene.frames.set = set;
    for (int s = 0; s < 2; ++s)
        scene.rotations.emplace_back(Eigen::AngleAxisf(float(random.uniform(0, 3)), random_unit(random)));
    for (std::size_t v = 0; v < 2 * count; ++v) scene.vertices.push_back(random_unit(random));
    for (std::size_t v = 0; v < count; ++v) {
        const auto segment = static_cast<std::uint32_t>(v % 2);
        const Vec3 reference = random_unit(random);
        scene.frames.segment.push_back(segment);
        scene.frames.neighbor.push_back(static_cast<std::uint32_t>(count + v));
        scene.frames.reference_normal.push_back(reference);
        const Vec3 normal = scene.rotations[segment] * (reference + 0.5f * random_unit(random)).normalized();
        const TangentFrame frame = frame_of_normal(normal);
        const auto angle = static_cast<float>(random.uniform(0, 3.1));
        const Vec3 e1 = std::cos(angle) * frame.tangent + std::sin(angle) * frame.bitangent;
        scene.normals.push_back(normal);
        scene.frames.reference_direction.emplace_back(scene.rotations[segment].transpose() * e1);
        const auto k2 = static_cast<float>(random.normal());
        scene.curvature.k1.push_back(k2 + static_cast<float>(random.uniform(0.1, 2)));
        scene.curvature.k2.push_back(k2);
        scene.curvature.e1.push_back(e1);
        scene.curvature.e2.push_back(normal.cross(e1));
        scene.curvature.derivative.push_back(
            {float(random.normal()), float(random.normal()), float(random.normal()), float(random.normal())});
    }
    return scene;
}

std::vector<float> encoded(const AttributeScene& scene) {
    std::vector<float> attributes(attribute_count(scene.frames.set) * scene.frames.vertex_count());
    scene.frames.encode(scene.curvature, scene.surface(), attributes);
    return attributes;
}

class AttributesTest : public ::testing::TestWithParam<AttributeSet> {};

TEST_P(AttributesTest, DecodeToTheCurvatureTheyWereMadeFrom) {
    const AttributeScene scene = random_attribute_scene(GetParam(), 200, 1);
    VertexCurvature back;
    scene.frames.decode(encoded(scene), scene.surface(), back);
    for (std::size_t v = 0; v < 200; ++v) {
        EXPECT_NEAR(back.k1[v], scene.curvature.k1[v], 1e-4);
        EXPECT_NEAR(back.k2[v], scene.curvature.k2[v], 1e-4);
        const float along = back.e1[v].dot(scene.curvature.e1[v]), sign = along < 0 ? -1.0f : 1.0f;
        EXPECT_NEAR(std::abs(along), 1, 1e-3);
        EXPECT_NEAR(back.e1[v].cross(back.e2[v]).dot(scene.normals[v]), 1, 1e-3);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_NEAR(sign * back.derivative[v][k], scene.curvature.derivative[v][k], 2e-3);
    }
}

TEST_P(AttributesTest, DoNotChangeWhenEverythingTurns) {
    AttributeScene scene = random_attribute_scene(GetParam(), 100, 2);
    const std::vector<float> before = encoded(scene);
    const Eigen::Matrix3f turn(Eigen::AngleAxisf(1.3f, Vec3(1, 2, -1).normalized()));
    for (auto& rotation : scene.rotations) rotation = turn * rotation;
    for (auto* vectors : {&scene.vertices, &scene.normals, &scene.curvature.e1, &scene.curvature.e2})
        for (Vec3& v : *vectors) v = turn * v;
    const std::vector<float> after = encoded(scene);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-4);
}

// The direction's sign is arbitrary; with it, four signs of the derivative.
TEST_P(AttributesTest, DoNotDependOnTheSignOfTheDirection) {
    AttributeScene scene = random_attribute_scene(GetParam(), 100, 3);
    const std::vector<float> before = encoded(scene);
    for (std::size_t v = 0; v < 100; v += 2) {
        scene.curvature.e1[v] *= -1;
        scene.curvature.e2[v] *= -1;
        for (float& c : scene.curvature.derivative[v]) c = -c;
    }
    const std::vector<float> after = encoded(scene);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Sets, AttributesTest, ::testing::Values(AttributeSet::principal, AttributeSet::tensor),
                         [](const auto& instance) {
                             return instance.param == AttributeSet::principal ? "principal" : "tensor";
                         });

// Where k1 and k2 change places the principal direction jumps by a right angle; the tensor does not notice.
TEST(Attributes, OfTheTensorStaySmoothThroughAnUmbilic) {
    AttributeScene scene = random_attribute_scene(AttributeSet::tensor, 1, 4);
    const Vec3 normal = scene.normals[0], u = frame_of_normal(normal).tangent, v = normal.cross(u);
    const FormDerivative along_u{1, 2, 3, 4};
    const auto set_umbilic = [&](float difference) {
        const bool u_first = difference > 0;
        scene.curvature.k1[0] = 1 + std::abs(difference);
        scene.curvature.k2[0] = 1 - std::abs(difference);
        scene.curvature.e1[0] = u_first ? u : v;
        scene.curvature.e2[0] = u_first ? v : Vec3(-u);
        scene.curvature.derivative[0] = u_first ? along_u : in_rotated_frame(along_u, TangentRotation{0, 1});
    };
    set_umbilic(1e-3f);
    const std::vector<float> before = encoded(scene);
    set_umbilic(-1e-3f);
    const std::vector<float> after = encoded(scene);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 5e-3);
}

TEST(Attributes, EdgesThatStandUprightHaveSomeTangent) {
    const Vec3 normal = Vec3(1, 2, 3).normalized();
    const Vec3 tangent = edge_tangent(2 * normal, normal);
    EXPECT_NEAR(tangent.dot(normal), 0, 1e-6);
    EXPECT_NEAR(tangent.norm(), 1, 1e-5);
    EXPECT_TRUE(edge_tangent(Vec3::Zero(), normal).allFinite());
    const Vec3 flat = frame_of_normal(normal).bitangent;
    EXPECT_NEAR((edge_tangent(3 * flat + normal, normal) - flat).norm(), 0, 1e-5);
}

}  // namespace
}  // namespace exemplar
