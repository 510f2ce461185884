// Regional means on a shape whose answers are known.
#include "host/labeling/features/feature_families.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

/// A thin rod along z: everything on it is a function of z.
class Rod : public ::testing::Test {
  protected:
    Rod() : prepared_(prepare_mesh(shapes::cylinder(0.01F, 2.0F, 6, 200, true), 400)) {
        for (const Vec3& p : prepared_.center) half_ = std::max(half_, std::abs(p.z()));
    }

    PreparedMesh prepared_;
    float half_ = 0.0F;
};

TEST_F(Rod, AveragesValuesOverTheRegion) {
    FeatureMatrix unary;
    unary.rows = prepared_.face_count();
    unary.add("geodesic.mean");
    unary.add("diameter.mean@60");
    for (std::size_t f = 0; f < unary.rows; ++f) {
        unary.column(0)[f] = 3.0F;
        unary.column(1)[f] = prepared_.center[f].z();
    }
    const FeatureMatrix regions = region_features(prepared_, unary);
    ASSERT_EQ(regions.cols(), 12U);
    const std::span<const float> mean = column(regions, "region.mean.diameter.mean@60@0.4");
    const float stretch = 1.35F;  // paths over the faces are up to so much longer than straight ones
    for (std::size_t f = 0; f < unary.rows; ++f) {
        EXPECT_FLOAT_EQ(column(regions, "region.mean.geodesic.mean@0.1")[f], 3.0F);
        EXPECT_NEAR(column(regions, "region.difference.geodesic.mean@0.4")[f], 0.0F, 1e-5F);
        // The middle of what lies within the radius, which the rod's ends cut off.
        const float z = prepared_.center[f].z(), radius = 0.4F * prepared_.median_distance;
        const float longest = 0.5F * (std::max(z - radius, -half_) + std::min(z + radius, half_));
        const float shortest = 0.5F * (std::max(z - radius / stretch, -half_) + std::min(z + radius / stretch, half_));
        EXPECT_GE(mean[f], std::min(longest, shortest) - 0.02F * half_);
        EXPECT_LE(mean[f], std::max(longest, shortest) + 0.02F * half_);
    }
}

}  // namespace
}  // namespace exemplar
