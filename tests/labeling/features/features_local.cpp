
#include "host/labeling/features/cubic_patch.h"
#include "host/labeling/features/feature_families.h"
#include "host/shape/sample_cells.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

TEST(CubicPatch, RecoversAHeightField) {
    // z = -0.3 x^2 + 0.1 x y + 0.2 y^2 + 0.05 x^3, its normals exact; turned so that the frame is not the axes'.
    const Eigen::Matrix3f turn = shapes::random_rotation(2);
    CubicPatch patch(Vec3::Zero(), turn * Vec3::UnitZ(), 0.5F);
    for (float x = -0.5F; x <= 0.51F; x += 0.1F) {
        for (float y = -0.5F; y <= 0.51F; y += 0.1F) {
            const Vec3 p(x, y, -0.3F * x * x + 0.1F * x * y + 0.2F * y * y + 0.05F * x * x * x);
            const Vec3 n(0.6F * x - 0.1F * y - 0.15F * x * x, -0.1F * x - 0.4F * y, 1.0F);
            patch.add(turn * p, (turn * n).normalized(), 0.01F);
        }
    }
    const PatchCurvature curvature = patch.solve();
    // Second derivatives -0.6, 0.1, 0.4; curvature has the other sign.
    const float spread = std::hypot(0.5F, 0.1F);
    EXPECT_NEAR(curvature.k1, 0.1F + spread, 2e-3F);
    EXPECT_NEAR(curvature.k2, 0.1F - spread, 2e-3F);
    const float cosine = std::cos(0.5F * std::atan2(0.1F, 0.5F)), sine = std::sin(0.5F * std::atan2(0.1F, 0.5F));
    EXPECT_NEAR(curvature.dk1, 0.3F * cosine * cosine * cosine, 5e-3F);
    EXPECT_NEAR(curvature.dk2, 0.3F * sine * sine * sine, 5e-3F);
}

TEST(CubicPatch, LeavesOutFoldsAndNothing) {
    CubicPatch patch(Vec3::Zero(), Vec3::UnitZ(), 1.0F);
    EXPECT_EQ(patch.solve().k1, 0.0F);
    patch.add(Vec3(0.3F, 0, 0.4F), -Vec3::UnitZ(), 1.0F);
    EXPECT_EQ(patch.solve().k1, 0.0F);
}

float normalized_radius(const TriangleMesh& mesh, std::size_t samples) {
    return prepare_mesh(mesh, samples).mesh.vertices[0].norm();
}

TEST(CurvatureFeatures, OfASphereAreItsInverseRadius) {
    const TriangleMesh sphere = shapes::icosphere(4, 3.0F);
    const MeshFeatures features = compute_features(sphere);
    const float truth = 1.0F / normalized_radius(sphere, 1000);
    constexpr float k_error = 0.02F;
    for (const char* radius : {"@0.01", "@0.02", "@0.05", "@0.1"}) {
        for (const char* function : {"k1", "k2", "mean", "|k1|"}) {
            for (const float k : column(features.unary, std::string("curvature.") + function + radius)) {
                ASSERT_NEAR(k, truth, k_error * truth) << function << radius;
            }
        }
        for (const float k : column(features.unary, std::string("curvature.k1*k2") + radius)) {
            ASSERT_NEAR(k, truth * truth, 2.0F * k_error * truth * truth) << radius;
        }
    }
    for (const float k : column(features.pairwise, "curvature.k1@0.04")) EXPECT_NEAR(k, truth, k_error * truth);
}

TEST(CurvatureFeatures, OfACylinderAndATorus) {
    const MeshFeatures tube = compute_features(shapes::cylinder(1.0F, 6.0F, 48, 48, false));
    const PreparedMesh prepared = prepare_mesh(shapes::cylinder(1.0F, 6.0F, 48, 48, false), 1000);
    const float radius = prepared.mesh.vertices[0].head<2>().norm();
    const std::span<const float> k1 = column(tube.unary, "curvature.k1@0.1"),
                                 k2 = column(tube.unary, "curvature.k2@0.1");
    for (std::size_t f = k1.size() / 3; f < 2 * k1.size() / 3; ++f) {
        EXPECT_NEAR(k1[f], 1.0F / radius, 0.03F / radius);
        EXPECT_NEAR(k2[f], 0.0F, 0.03F / radius);
    }
    const TriangleMesh ring = shapes::torus(1.0F, 0.4F, 96, 48);
    const PreparedMesh ring_prepared = prepare_mesh(ring, 1000);
    const MeshFeatures features = compute_features(ring);
    const float unit = ring_prepared.mesh.vertices[0].norm() / ring.vertices[0].norm();
    for (std::size_t f = 0; f < ring.face_count(); ++f) {
        const Vec3 p = ring_prepared.center[f] / unit;
        const float from_axis = p.head<2>().norm();
        const float k2_truth = (from_axis - 1.0F) / 0.4F / from_axis;
        // The wider patch spans half of the tube's radius, where a cubic height field no longer follows it closely.
        for (const auto& [patch, error] : {std::pair("@0.05", 0.06F), std::pair("@0.1", 0.18F)}) {
            EXPECT_NEAR(column(features.unary, std::string("curvature.k1") + patch)[f] * unit, 1.0F / 0.4F, error);
            EXPECT_NEAR(column(features.unary, std::string("curvature.k2") + patch)[f] * unit, k2_truth, error);
        }
    }
}

TEST(CurvatureFeatures, OfAPlaneAreZero) {
    const MeshFeatures features = compute_features(shapes::grid(20, 20, 1.0F));
    for (const FeatureMatrix* matrix : {&features.unary, &features.pairwise}) {
        for (std::size_t k = 0; k < matrix->cols(); ++k) {
            if (!matrix->names[k].starts_with("curvature.")) continue;
            for (const float value : matrix->column(k)) ASSERT_NEAR(value, 0.0F, 1e-4F) << matrix->names[k];
        }
    }
}

TEST(PcaFeatures, OfAFlatDiskAreHalfItsRadius) {
    const MeshFeatures features = compute_features(shapes::grid(50, 50, 1.0F));
    const std::size_t middle = 2 * (25 * 50 + 25);
    // A disk of radius R has a standard deviation of R / 2 along each diameter; paths on the dual graph of a regular
    // grid are up to 1.5 times as long as straight lines, which shrinks the disk, in some directions more than in
    // others.
    for (const char* radius : {"@0.2", "@0.3", "@0.5"}) {
        const float s1 = column(features.unary, std::string("pca.s1") + radius)[middle];
        const float s2 = column(features.unary, std::string("pca.s2") + radius)[middle];
        EXPECT_LT(s1, 0.5F);
        EXPECT_GT(s2, 0.3F);
        EXPECT_LT(s1 / s2, 1.5F);
        EXPECT_NEAR(column(features.unary, std::string("pca.s1/s3") + radius)[middle], 100.0F, 0.1F);  // the bound
        EXPECT_NEAR(column(features.unary, std::string("pca.(s1+s2)/sum") + radius)[middle], 1.0F, 0.01F);
    }
}

TEST(PcaFeatures, OfAThinRodLieAlongIt) {
    const MeshFeatures features = compute_features(shapes::cylinder(0.02F, 10.0F, 8, 300, true));
    const std::span<const float> share = column(features.unary, "pca.s1/sum@0.5"),
                                 s1 = column(features.unary, "pca.s1@0.2");
    for (std::size_t f = 2000; f < 2800; ++f) {
        EXPECT_GT(share[f], 0.95F);
        EXPECT_NEAR(s1[f], 1.0F / std::sqrt(3.0F), 0.06F);  // a segment of half length 1
    }
}

TEST(SampleCells, HoldTheWholeSurface) {
    const PreparedMesh prepared = prepare_mesh(lopsided_torus(30, 20), 60);
    SurfaceMoments all, cells;
    for (std::size_t f = 0; f < prepared.face_count(); ++f) {
        all.add(prepared.center[f].cast<double>(), static_cast<double>(prepared.area_share[f]));
    }
    for (const SampleCell& cell : sample_cells(prepared)) {
        cells.add(cell.moments, 1.0);
        EXPECT_GT(cell.radius, 0.0F);
        EXPECT_EQ(cell.share_within(2.0F - cell.radius * 1.01F, 2.0F), 1.0F);
        EXPECT_EQ(cell.share_within(2.0F + cell.radius * 1.01F, 2.0F), 0.0F);
        EXPECT_NEAR(cell.share_within(2.0F, 2.0F), 0.5F, 1e-5F);
        EXPECT_EQ(cell.share_within(std::numeric_limits<float>::infinity(), 2.0F), 0.0F);
    }
    for (std::size_t k = 0; k < all.sums.size(); ++k) EXPECT_NEAR(all.sums[k], cells.sums[k], 1e-9);
}

}  // namespace
}  // namespace exemplar
