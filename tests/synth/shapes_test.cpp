#include "host/synth/shapes/shapes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/mesh/topology.h"
#include "tests/support/manifold.h"

namespace exemplar {
namespace {

constexpr std::uint64_t k_seeds = 3;

/// Shapes are made once for all tests of this program.
const SynthShape& shape_of(const std::string& kind, std::uint64_t seed, std::size_t faces = 6000) {
    static std::map<std::pair<std::string, std::uint64_t>, SynthShape> cache;
    const auto key = std::pair{kind + std::to_string(faces), seed};
    if (!cache.contains(key)) cache[key] = make_shape(kind, seed, faces);
    return cache.at(key);
}

double smallest_angle(const TriangleMesh& mesh, const Face& face) {
    double smallest = 180;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = mesh.vertices[face[(i + 1) % 3]] - mesh.vertices[face[i]];
        const Vec3 b = mesh.vertices[face[(i + 2) % 3]] - mesh.vertices[face[i]];
        smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 57.29578);
    }
    return smallest;
}

/// Number of connected regions of each label.
std::vector<int> label_regions(const SynthShape& shape) {
    const Topology topology = build_topology(shape.mesh);
    const auto& label = shape.labels.label;
    std::vector<std::uint32_t> parent(label.size());
    for (std::uint32_t f = 0; f < parent.size(); ++f) parent[f] = f;
    const auto root = [&](std::uint32_t f) {
        while (parent[f] != f) f = parent[f] = parent[parent[f]];
        return f;
    };
    for (const Edge& edge : topology.edges)
        if (label[edge.face[0]] == label[edge.face[1]]) parent[root(edge.face[0])] = root(edge.face[1]);
    std::vector<int> regions(shape.labels.names.size(), 0);
    for (std::uint32_t f = 0; f < parent.size(); ++f)
        if (parent[f] == f) ++regions[static_cast<std::size_t>(label[f])];
    return regions;
}

bool same_bytes(const SynthShape& a, const SynthShape& b) {
    return a.mesh.vertices.size() == b.mesh.vertices.size() && a.mesh.faces == b.mesh.faces &&
           std::memcmp(a.mesh.vertices.data(), b.mesh.vertices.data(), a.mesh.vertices.size() * sizeof(Vec3)) == 0 &&
           a.labels.label == b.labels.label && a.labels.names == b.labels.names;
}

class ShapesOfKind : public testing::TestWithParam<std::string> {};

TEST_P(ShapesOfKind, AreClosedManifoldsOrientedOutwardInOnePiece) {
    for (std::uint64_t seed = 0; seed < k_seeds; ++seed) {
        SCOPED_TRACE(seed);
        const TriangleMesh& mesh = shape_of(GetParam(), seed).mesh;
        EXPECT_TRUE(is_closed_and_oriented(mesh));
        EXPECT_TRUE(is_vertex_manifold(mesh));
        EXPECT_GT(signed_volume(mesh), 0);
        EXPECT_THAT(face_components(mesh, build_topology(mesh)), testing::Each(0u));
    }
}

TEST_P(ShapesOfKind, MeetTheFaceCount) {
    for (const std::size_t faces : {2000u, 6000u, 20001u}) {
        const TriangleMesh& mesh = shape_of(GetParam(), 0, faces).mesh;
        EXPECT_NEAR(static_cast<double>(mesh.face_count()), static_cast<double>(faces),
                    0.1 * static_cast<double>(faces));
        EXPECT_EQ(mesh.source_face_count, mesh.face_count());
        EXPECT_TRUE(mesh.source_face.empty());
    }
}

TEST_P(ShapesOfKind, HaveWellShapedTriangles) {
    for (std::uint64_t seed = 0; seed < k_seeds; ++seed) {
        SCOPED_TRACE(seed);
        const TriangleMesh& mesh = shape_of(GetParam(), seed).mesh;
        EXPECT_THAT(face_areas(mesh), testing::Each(testing::Gt(0.0f)));
        double sum = 0;
        std::size_t narrow = 0;
        for (const Face& face : mesh.faces) {
            const double angle = smallest_angle(mesh, face);
            sum += angle;
            if (angle < 15) ++narrow;
        }
        EXPECT_GT(sum / static_cast<double>(mesh.face_count()), 44);
        EXPECT_LT(narrow, mesh.face_count() / 200);
    }
}

TEST_P(ShapesOfKind, LabelEveryFaceAndShowEveryPart) {
    const auto names = synth_labels(GetParam());
    for (std::uint64_t seed = 0; seed < k_seeds; ++seed) {
        SCOPED_TRACE(seed);
        const SynthShape& shape = shape_of(GetParam(), seed);
        EXPECT_THAT(shape.labels.names, testing::ElementsAreArray(names.begin(), names.end()));
        ASSERT_EQ(shape.labels.label.size(), shape.mesh.face_count());
        EXPECT_THAT(shape.labels.label,
                    testing::Each(testing::AllOf(testing::Ge(0), testing::Lt(static_cast<int>(names.size())))));
        EXPECT_THAT(label_regions(shape), testing::Each(testing::AllOf(testing::Ge(1), testing::Le(12))));
    }
}

TEST_P(ShapesOfKind, AreTheSameBytesForTheSameSeedOnAnyNumberOfThreads) {
    const ThreadLimit one(1);
    EXPECT_TRUE(same_bytes(make_shape(GetParam(), 1, 6000), shape_of(GetParam(), 1)));
}

TEST_P(ShapesOfKind, DifferBetweenSeeds) {
    EXPECT_NE(shape_of(GetParam(), 0).mesh.vertices, shape_of(GetParam(), 1).mesh.vertices);
    EXPECT_NE(shape_of(GetParam(), 1).labels.label, shape_of(GetParam(), 2).labels.label);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ShapesOfKind,
                         testing::ValuesIn(std::vector<std::string>(synth_kinds().begin(), synth_kinds().end())),
                         [](const auto& kind) { return kind.param; });

TEST(Shapes, HaveTheLimbsTheirBodiesHave) {
    for (std::uint64_t seed = 0; seed < k_seeds; ++seed) {
        SCOPED_TRACE(seed);
        // head, neck, torso, leg, tail, ear
        EXPECT_THAT(label_regions(shape_of("fourleg", seed)), testing::ElementsAre(1, 1, 1, 4, 1, 2));
        // thighs may meet at the crotch
        EXPECT_THAT(label_regions(shape_of("human", seed)),
                    testing::ElementsAre(1, 1, 1, 2, 2, 2, testing::Le(2), 2, 2));
        EXPECT_THAT(label_regions(shape_of("cup", seed)), testing::ElementsAre(1, 1));
        EXPECT_THAT(label_regions(shape_of("glasses", seed)), testing::ElementsAre(1, 4, 2));  // a lens has two sides
    }
}

TEST(Shapes, RandomOrientationTurnsTheSameShape) {
    const SynthShape& upright = shape_of("chair", 2);
    const SynthShape turned = make_shape("chair", 2, 6000, true);
    EXPECT_EQ(turned.mesh.faces, upright.mesh.faces);
    EXPECT_EQ(turned.labels.label, upright.labels.label);
    EXPECT_NEAR(signed_volume(turned.mesh), signed_volume(upright.mesh), 1e-4);
    double moved = 0;
    for (std::size_t v = 0; v < turned.mesh.vertex_count(); ++v)
        moved = std::max(moved, static_cast<double>((turned.mesh.vertices[v] - upright.mesh.vertices[v]).norm()));
    EXPECT_GT(moved, 0.05);
}

TEST(Shapes, AbsurdFaceCountsAreUsageErrors) {
    for (const std::size_t faces : {std::size_t{0}, std::size_t{99}, std::size_t{1} << 20, ~std::size_t{0}})
        EXPECT_THROW(make_shape("cup", 1, faces), UsageError) << faces;
    EXPECT_GT(make_shape("cup", 1, 100).mesh.face_count(), 50u);
}

TEST(Shapes, UnknownKindIsAUsageErrorWithASuggestion) {
    try {
        make_shape("chiar", 1);
        FAIL() << "no error";
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'chair'"));
        EXPECT_THAT(error.what(), testing::HasSubstr("octopus"));
    }
    EXPECT_THROW(synth_labels(""), UsageError);
}

}  // namespace
}  // namespace exemplar
