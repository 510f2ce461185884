// Faces arranged so that a careless method takes far more time or memory than for other meshes: what the features cost
// is counted, not timed.

#include <limits>

#include "host/core/errors.h"
#include "host/labeling/features/feature_families.h"
#include "host/synth/arrangements/arrangements.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

TEST(FeaturesOfArrangements, AreFinite) {
    for (const Arrangement& arrangement : arrangements()) {
        SCOPED_TRACE(arrangement.name);
        const TriangleMesh mesh = arrangement.make(3000);
        EXPECT_NEAR(static_cast<double>(mesh.face_count()), 3000.0, 300.0);
        expect_finite(compute_features(mesh), mesh.face_count());
    }
    EXPECT_THROW(arrangement_named("heap"), UsageError);
}

TEST(FeaturesOfArrangements, NeighborhoodsOfACrowdedBallAreBounded) {
    const PreparedMesh prepared = prepare_mesh(arrangement_named("floor").make(6000), 1000);
    const float radius = 0.05F * prepared.median_distance;
    GeodesicSearch search(prepared.graph);
    ASSERT_GT(search.within(0, radius).size(), 5000U);  // without a bound the whole ball
    std::vector<std::size_t> size(prepared.face_count(), 0);
    for_each_neighborhood(prepared, radius, 10, [&](std::uint32_t face, Neighborhood near) {
        size[face] = near.faces.size();
        if (face + 2 < prepared.face_count()) {
            EXPECT_LT(near.complete_distance, radius);
        }
        EXPECT_LT(near.faces.back().distance, near.complete_distance);  // of equally near ones all or none
    });
    EXPECT_LE(std::ranges::max(size), 1024U);
    EXPECT_GT(size[0], 900U);
}

TEST(FeaturesOfArrangements, EdgeNeighborhoodsOfACrowdedBallAreBounded) {
    const PreparedMesh prepared = prepare_mesh(arrangement_named("floor").make(6000), 1000);
    const InteriorEdges edges = interior_edges(prepared);
    EdgeNeighborhood near;
    dihedral_features(prepared, edges, near);
    const std::size_t bound = max_edge_neighborhood(edges.face.size());
    for (std::size_t e = 0; e < edges.face.size(); ++e) ASSERT_LE(near.begin[e + 1] - near.begin[e], bound);
    EXPECT_GT(near.edge.size(), edges.face.size() * bound / 2);
}

TEST(FeaturesOfArrangements, OrdinaryNeighborhoodsAreComplete) {
    const PreparedMesh prepared = prepare_mesh(lopsided_torus(80, 50), 1000);
    const float radius = 0.2F * prepared.median_distance;
    GeodesicSearch search(prepared.graph);
    for_each_neighborhood(prepared, radius, 1, [&](std::uint32_t, Neighborhood near) {
        EXPECT_EQ(near.complete_distance, std::numeric_limits<float>::infinity());
    });
}

TEST(FeaturesOfArrangements, ARegionCutShortIsMeasuredFromSamples) {
    // All of the ball is within 5% of the distances on the floor, more faces than a neighborhood may have.
    const PreparedMesh prepared = prepare_mesh(arrangement_named("floor").make(6000), 1000);
    PcaFamily regions(prepared);
    for_each_neighborhood(prepared, regions.radius(), k_min_region_faces,
                          [&](std::uint32_t face, Neighborhood near) { regions.measure(face, near); });
    regions.measure_large_radii();
    const FeatureMatrix pca = regions.take();
    // The standard deviations of a sphere are equal.
    EXPECT_NEAR(column(pca, "pca.s1/s3@0.05")[0], 1.0F, 0.02F);
    EXPECT_NEAR(column(pca, "pca.s1/s3@0.1")[3000], 1.0F, 0.02F);
}

TEST(FeaturesOfArrangements, NormalsOfAFanAreThoseOfTheCone) {
    const std::size_t faces = 4000;
    const PreparedMesh prepared = prepare_mesh(arrangement_named("cone").make(faces), 100);
    double worst = 1.0;
    for (std::size_t f = 0; f < faces; f += 2) {
        const Vec3 outward = Vec3(prepared.center[f].x(), prepared.center[f].y(), 0.0F).normalized();
        const Vec3 expected = Vec3(1.5F * outward + Vec3::UnitZ()).normalized();
        worst = std::min(worst, static_cast<double>(expected.dot(prepared.normal[f])));
    }
    EXPECT_GT(worst, 0.99);
}

}  // namespace
}  // namespace exemplar
