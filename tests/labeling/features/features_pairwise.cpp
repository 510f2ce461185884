
#include "host/labeling/features/feature_families.h"
#include "host/shape/log_bins.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

TEST(PairwiseFeatures, DihedralsOfABoxAreFlatOrConvex) {
    const MeshFeatures features = compute_features(shapes::box(1, 2, 3, 3));
    // Flat and convex edges both have min(omega / pi, 1) = 1.
    for (const float value : column(features.pairwise, "dihedral.edge^1")) EXPECT_NEAR(value, 1.0F, 1e-3F);
    for (const float value : features.dihedral) EXPECT_NEAR(value, 1.0F, 1e-3F);
}

/// A sheet folded upward by a right angle along the line x = 1/2; z points outward, so the fold is concave.
TriangleMesh folded_sheet() {
    return shapes::transformed(shapes::grid(10, 10, 1.0F), [](const Vec3& p) -> Vec3 {
        return {p.x(), p.y(), std::abs(p.x() - 0.5F)};
    });
}

TEST(PairwiseFeatures, AConcaveFoldIsHalf) {
    const MeshFeatures features = compute_features(folded_sheet());
    const std::span<const float> first = column(features.pairwise, "dihedral.edge^1");
    const std::span<const float> third = column(features.pairwise, "dihedral.edge^3");
    const std::span<const float> near = column(features.pairwise, "dihedral.mean@0.04^1");
    std::size_t folds = 0;
    for (std::size_t e = 0; e < first.size(); ++e) {
        EXPECT_NEAR(third[e], first[e] * first[e] * first[e], 1e-5F);
        EXPECT_EQ(first[e], features.dihedral[e]);
        EXPECT_GE(near[e], 0.49F);
        EXPECT_LE(near[e], 1.001F);
        if (first[e] < 0.99F) {
            ++folds;
            EXPECT_NEAR(first[e], 0.5F, 1e-3F);
        }
    }
    EXPECT_EQ(folds, 10U);
}

TEST(PairwiseFeatures, DifferencesAreThoseOfTheFaces) {
    const MeshFeatures features = compute_features(lopsided_torus(24, 16));
    for (const char* name : {"diameter.mean@30", "diameter.median@120/log8", "medial.mean_square@60"}) {
        const std::span<const float> unary = column(features.unary, name), pair = column(features.pairwise, name);
        for (std::size_t e = 0; e < pair.size(); ++e) {
            EXPECT_EQ(pair[e], std::abs(unary[features.edges[e][0]] - unary[features.edges[e][1]]));
        }
    }
}

TEST(PairwiseFeatures, LengthsAndAreasAreInMedianUnits) {
    const MeshFeatures features = compute_features(lopsided_torus(24, 16));
    const auto median = [](std::vector<float> values) {
        std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
        return values[values.size() / 2];
    };
    EXPECT_NEAR(median(features.edge_length), 1.0F, 1e-5F);
    EXPECT_NEAR(median(features.face_area), 1.0F, 1e-5F);
}

TEST(EdgeNeighborhoodOfAMesh, IsSymmetricAndHoldsTheEdgeItself) {
    const PreparedMesh prepared = prepare_mesh(lopsided_torus(64, 40), 300);
    const InteriorEdges edges = interior_edges(prepared);
    EdgeNeighborhood near;
    dihedral_features(prepared, edges, near);
    const std::size_t count = edges.face.size();
    std::vector<std::vector<std::pair<std::uint32_t, std::uint8_t>>> of_edge(count);
    for (std::size_t e = 0; e < count; ++e) {
        for (std::uint32_t i = near.begin[e]; i < near.begin[e + 1]; ++i)
            of_edge[e].emplace_back(near.edge[i], near.bin[i]);
        ASSERT_FALSE(of_edge[e].empty());
        EXPECT_EQ(of_edge[e].front(), (std::pair<std::uint32_t, std::uint8_t>(static_cast<std::uint32_t>(e), 0)));
    }
    EXPECT_GT(near.edge.size(), 4 * count);
    std::size_t asymmetric = 0;
    for (std::uint32_t e = 0; e < count; ++e) {
        for (const auto& [other, bin] : of_edge[e]) {
            ASSERT_LT(bin, EdgeNeighborhood::k_bins);
            const auto back = std::ranges::find(of_edge[other], std::pair(e, bin));
            asymmetric += back == of_edge[other].end();
        }
    }
    EXPECT_LE(asymmetric, near.edge.size() / 10000);  // paths add up in another order the other way
}

TEST(EdgeNeighborhoodOfAMesh, RangesFollowTheDistance) {
    const PreparedMesh prepared = prepare_mesh(lopsided_torus(64, 40), 300);
    const InteriorEdges edges = interior_edges(prepared);
    EdgeNeighborhood near;
    dihedral_features(prepared, edges, near);
    const auto limits = log_bin_edges<EdgeNeighborhood::k_bins>(0.05F * prepared.median_distance);
    const auto midpoint = [&](std::uint32_t e) -> Vec3 {
        return 0.5F * (prepared.mesh.vertices[edges.vertex[e][0]] + prepared.mesh.vertices[edges.vertex[e][1]]);
    };
    for (std::uint32_t e = 0; e < edges.face.size(); e += 13) {
        for (std::uint32_t i = near.begin[e]; i < near.begin[e + 1]; ++i) {
            // A path is no shorter than the straight line, and in so small a patch not much longer.
            const float straight = (midpoint(e) - midpoint(near.edge[i])).norm();
            EXPECT_LE(straight, limits[near.bin[i] + 1U] * 1.0001F);
            EXPECT_GE(straight * 2.0F + 1e-6F, limits[near.bin[i]]);
        }
    }
}

}  // namespace
}  // namespace exemplar
