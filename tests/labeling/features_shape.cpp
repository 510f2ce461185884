// The families that say what a face's values mean in its shape, on shapes whose answers are known.
#include "host/labeling/feature_families.h"
#include "tests/labeling/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

/// A thin rod along z: everything on it is a function of z.
class Rod : public ::testing::Test {
  protected:
    Rod() : prepared(prepare_mesh(shapes::cylinder(0.01F, 2.0F, 6, 200, true), 400)) {
        for (const Vec3& p : prepared.center) half = std::max(half, std::abs(p.z()));
    }
    float height(std::size_t face) const { return prepared.center[face].z() / half; }

    PreparedMesh prepared;
    float half = 0.0F;
};

TEST_F(Rod, HasTwoLimbsThatMeetInTheMiddle) {
    const FeatureMatrix geodesic = geodesic_features(prepared);
    const std::vector<float> width(prepared.face_count(), 0.25F);
    const FeatureMatrix limbs = limb_features(prepared, geodesic.column(0), width);
    ASSERT_EQ(limbs.cols(), 18U);
    for (const std::string at : {"@0.02", "@0.08", "@0.2"}) {
        for (std::size_t f = 0; f < prepared.face_count(); ++f) {
            if (std::abs(height(f)) < 0.15F) continue;  // the last faces belong to neither
            EXPECT_NEAR(column(limbs, "limb.area" + at)[f], 0.5F, 0.05F);
            EXPECT_NEAR(column(limbs, "limb.height" + at)[f], height(f) * height(f), 0.06F);
            EXPECT_NEAR(column(limbs, "limb.width" + at)[f], 0.25F, 1e-5F);
            EXPECT_FLOAT_EQ(column(limbs, "limb.length" + at)[f],
                            column(limbs, "limb.tip" + at)[f] - column(limbs, "limb.base" + at)[f]);
        }
    }
}

TEST_F(Rod, RanksFacesByTheAreaBelowThem) {
    FeatureMatrix unary;
    unary.rows = prepared.face_count();
    const std::span<float> level = unary.add("geodesic.mean");
    for (std::size_t f = 0; f < unary.rows; ++f) level[f] = std::exp(height(f));
    unary.add("pca.s1/sum@0.1");    // not ranked: a ratio
    unary.add("diameter.mean@30");  // ranked, all equal
    unary.add("spin.0");            // another family
    const FeatureMatrix ranks = rank_features(prepared, unary);
    ASSERT_EQ(ranks.names, (std::vector<std::string>{"rank.geodesic.mean", "rank.diameter.mean@30"}));
    for (std::size_t f = 0; f < unary.rows; ++f) {
        EXPECT_NEAR(ranks.column(0)[f], 0.5F + 0.5F * height(f), 0.02F);
        EXPECT_EQ(ranks.column(1)[f], ranks.column(1)[0]);
    }
}

TEST_F(Rod, AveragesValuesOverTheRegion) {
    FeatureMatrix unary;
    unary.rows = prepared.face_count();
    unary.add("geodesic.mean");
    unary.add("diameter.mean@60");
    for (std::size_t f = 0; f < unary.rows; ++f) {
        unary.column(0)[f] = 3.0F;
        unary.column(1)[f] = prepared.center[f].z();
    }
    const FeatureMatrix regions = region_features(prepared, unary);
    ASSERT_EQ(regions.cols(), 12U);
    const std::span<const float> mean = column(regions, "region.mean.diameter.mean@60@0.4");
    const float stretch = 1.35F;  // paths over the faces are up to so much longer than straight ones
    for (std::size_t f = 0; f < unary.rows; ++f) {
        EXPECT_FLOAT_EQ(column(regions, "region.mean.geodesic.mean@0.1")[f], 3.0F);
        EXPECT_NEAR(column(regions, "region.difference.geodesic.mean@0.4")[f], 0.0F, 1e-5F);
        // The middle of what lies within the radius, which the rod's ends cut off.
        const float z = prepared.center[f].z(), radius = 0.4F * prepared.median_distance;
        const float longest = 0.5F * (std::max(z - radius, -half) + std::min(z + radius, half));
        const float shortest = 0.5F * (std::max(z - radius / stretch, -half) + std::min(z + radius / stretch, half));
        EXPECT_GE(mean[f], std::min(longest, shortest) - 0.02F * half);
        EXPECT_LE(mean[f], std::max(longest, shortest) + 0.02F * half);
    }
}

TEST_F(Rod, KnowsHowFarFacesLieOut) {
    const FeatureMatrix position = position_features(prepared, context_geometry(prepared));
    ASSERT_EQ(position.cols(), 13U);
    for (std::size_t f = 0; f < prepared.face_count(); ++f) {
        EXPECT_NEAR(column(position, "position.principal0")[f], std::abs(prepared.center[f].z()), 0.01F * half);
        EXPECT_NEAR(column(position, "position.principal0/max")[f], std::abs(height(f)), 0.01F);
        EXPECT_NEAR(column(position, "position.radius")[f], std::abs(prepared.center[f].z()), 0.02F * half);
    }
}

}  // namespace
}  // namespace exemplar
