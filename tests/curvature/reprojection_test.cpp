#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/random.h"
#include "host/curvature/model/tiling.h"
#include "host/mesh/curvature/tangent_tensors.h"

// reproject_curvature() against reproject() with AttributeFrames::decode(). Tensors are compared in space, where frames
// that are not certain, as those of umbilics, say nothing; both round them to single precision.
namespace exemplar {
namespace {

constexpr float k_tolerance = 1e-5f;

Vec3 random_vector(Random& random) {
    return {float(random.normal()), float(random.normal()), float(random.normal())};
}
Eigen::MatrixXf random_matrix(std::size_t rows, std::size_t columns, Random& random) {
    return Eigen::MatrixXf::NullaryExpr(Eigen::Index(rows), Eigen::Index(columns),
                                        [&] { return float(random.normal()); });
}

struct Scene {
    AttributeFrames frames;
    std::vector<Vec3> vertices, normals;
    std::vector<Eigen::Matrix3f> rotations;
    BasisTiles tiles;
    std::vector<float> z;

    PosedSurface surface() const { return {vertices, normals, rotations}; }
};

// Random attributes with `components` of each, of which a vertex has any number; the first third of the vertices is
// flat, has no edge or an upright one, or is an umbilic.
Scene random_scene(AttributeSet set, std::size_t count, std::size_t components, std::uint64_t seed) {
    Random random(seed);
    Scene scene;
    scene.frames.set = set;
    for (int s = 0; s < 3; ++s)
        scene.rotations.emplace_back(
            Eigen::AngleAxisf(float(random.uniform(0, 3)), random_vector(random).normalized()));
    for (std::uint32_t v = 0; v < count; ++v) {
        const auto segment = std::uint32_t(random.index(3));
        const Vec3 reference = random_vector(random).normalized();
        scene.frames.segment.push_back(segment);
        scene.frames.neighbor.push_back(std::uint32_t(random.index(count)));
        scene.frames.reference_normal.push_back(reference);
        scene.vertices.push_back(random_vector(random));
        scene.normals.emplace_back(scene.rotations[segment] * (reference + 0.2f * random_vector(random)).normalized());
    }
    const std::size_t attributes = attribute_count(set);
    Eigen::MatrixXf means = random_matrix(attributes, count, random);
    if (set == AttributeSet::principal) means.row(2).array() += 4.0f;  // keeps e1 from vanishing
    std::vector<VertexBasis> bases;
    for (std::size_t a = 0; a < attributes; ++a)
        for (std::size_t c = 0; c < components; ++c) {
            VertexBasis basis{.attribute = a, .vertices = {}, .basis = {}, .first_component = 0};
            for (std::uint32_t v = std::uint32_t(count / 3); v < count; ++v)
                if (random.uniform() < 0.3) basis.vertices.push_back(v);
            basis.basis = 0.2f * random_matrix(basis.vertices.size(), 1, random);
            basis.first_component = std::uint32_t(scene.z.size());
            bases.push_back(basis);
            scene.z.push_back(float(random.normal()));
        }
    for (std::size_t v = 0; v < count / 3 && set == AttributeSet::tensor; ++v) {
        if (v % 2 == 0) means.col(Eigen::Index(v)).setZero();
        if (v % 4 == 0) means(0, Eigen::Index(v)) = means(2, Eigen::Index(v)) = 2.0f;
        if (v % 3 == 0) scene.frames.neighbor[v] = std::uint32_t(v);
        const Vec3 edge = scene.vertices[scene.frames.neighbor[v]] - scene.vertices[v];
        if (v % 3 == 1 && edge.norm() > 0) scene.normals[v] = edge.normalized();
    }
    scene.tiles = make_tiles(scene.frames, scene.vertices, means, bases, {});
    // What decoding reads is what tiles keep.
    for (std::size_t i = 0; i < scene.tiles.vertex.size() && set == AttributeSet::principal; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            scene.frames.reference_normal[scene.tiles.vertex[i]][Eigen::Index(k)] = from_half(
                scene.tiles
                    .reference[(3 * (i / BasisTiles::k_lanes) + k) * BasisTiles::k_lanes + i % BasisTiles::k_lanes]);
    return scene;
}

Eigen::Matrix3f form(const VertexCurvature& c, std::size_t v) {
    return c.k1[v] * c.e1[v] * c.e1[v].transpose() + c.k2[v] * c.e2[v] * c.e2[v].transpose();
}
// C(d, d, d)
float derivative_along(const Vec3& d, const VertexCurvature& c, std::size_t v) {
    const float a = d.dot(c.e1[v]), b = d.dot(c.e2[v]);
    const auto& [c111, c112, c122, c222] = c.derivative[v];
    return a * a * a * c111 + 3 * a * a * b * c112 + 3 * a * b * b * c122 + b * b * b * c222;
}

void expect_reference(const Scene& scene, Random& random) {
    VertexCurvature actual, expected;
    reproject_curvature(scene.tiles, scene.z, scene.surface(), actual);
    std::vector<float> attributes(attribute_count(scene.frames.set) * scene.tiles.vertex_count);
    reproject(scene.tiles, scene.z, attributes);
    scene.frames.decode(attributes, scene.surface(), expected);
    for (std::size_t v = 0; v < scene.tiles.vertex_count; ++v) {
        ASSERT_GE(actual.k1[v], actual.k2[v]);
        ASSERT_NEAR(actual.e1[v].norm(), 1, k_tolerance);
        ASSERT_NEAR(actual.e1[v].dot(scene.normals[v]), 0, k_tolerance);
        ASSERT_NEAR((actual.e2[v] - scene.normals[v].cross(actual.e1[v])).norm(), 0, k_tolerance);
        ASSERT_NEAR((form(actual, v) - form(expected, v)).norm(), 0, k_tolerance * (1 + form(expected, v).norm()))
            << "vertex " << v;
        for (int i = 0; i < 5; ++i) {
            const Vec3 direction = random_vector(random).normalized();
            ASSERT_NEAR(derivative_along(direction, actual, v), derivative_along(direction, expected, v),
                        5 * k_tolerance)
                << "vertex " << v;
        }
    }
}

TEST(Reprojection, GivesWhatItsReferenceGives) {
    Random random(1);
    for (const AttributeSet set : {AttributeSet::tensor, AttributeSet::principal})
        for (const std::size_t count : {1u, 7u, 8u, 9u, 15u, 16u, 17u, 300u})
            for (const std::size_t components : {0u, 1u, 2u, 3u, 12u}) {
                SCOPED_TRACE(::testing::Message() << count << " vertices, " << components << " components");
                expect_reference(random_scene(set, count, components, 10 * count + components), random);
            }
}

}  // namespace
}  // namespace exemplar
