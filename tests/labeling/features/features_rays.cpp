#include <numbers>

#include "host/labeling/features/feature_families.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

TEST(RayStatistics, KeepWhatIsNearTheMedian) {
    const std::vector<float> length{1.0F, 1.1F, 0.9F, k_missed, 1.0F, 9.0F}, weight{1, 1, 1, 1, 1, 1};
    const auto statistics = ray_statistics(length, weight);
    ASSERT_TRUE(statistics.has_value());
    EXPECT_FLOAT_EQ(statistics->median, 1.0F);
    EXPECT_NEAR(statistics->mean, 1.0F, 1e-6F);  // without the 9
    EXPECT_NEAR(statistics->mean_square, (1.0F + 1.21F + 0.81F + 1.0F) / 4.0F, 1e-5F);
    EXPECT_FALSE(ray_statistics(std::vector<float>{k_missed, k_missed}, weight).has_value());
    EXPECT_FALSE(ray_statistics(std::span<const float>{}, std::span<const float>{}).has_value());
}

TEST(RayStatistics, WeighByTheGivenWeights) {
    const std::vector<float> length{2.0F, 3.0F, 2.0F, 3.0F}, weight{3.0F, 1.0F, 3.0F, 1.0F};
    const auto statistics = ray_statistics(length, weight);
    EXPECT_FLOAT_EQ(statistics->median, 2.5F);
    EXPECT_FLOAT_EQ(statistics->mean, 2.25F);
    EXPECT_FLOAT_EQ(statistics->mean_square, 5.25F);
}

TEST(InwardRays, PatternFillsItsCones) {
    const InwardRayPattern& pattern = inward_ray_pattern();
    EXPECT_EQ(pattern.cone_end.back(), InwardRayPattern::k_rays);
    for (std::size_t cone = 0; cone < k_cones; ++cone) {
        const float half = static_cast<float>(k_cone_angles[cone]) * std::numbers::pi_v<float> / 360.0F;
        EXPECT_NEAR(pattern.angle[pattern.cone_end[cone] - 1], half, 1e-5F);
        if (cone + 1 < k_cones) {
            EXPECT_GT(pattern.angle[pattern.cone_end[cone]], half + 0.01F);
        }
    }
    EXPECT_EQ(pattern.angle[0], 0.0F);
}

TEST(InwardRays, OfASphereAreItsChords) {
    const PreparedMesh prepared = prepare_mesh(shapes::icosphere(4, 1.0F), 200);
    const float radius = prepared.mesh.vertices[0].norm();
    const InwardRays rays = cast_inward_rays(prepared, RayScene(prepared.mesh));
    const InwardRayPattern& pattern = inward_ray_pattern();
    for (std::size_t f = 0; f < prepared.face_count(); f += 37) {
        for (std::size_t k = 0; k < InwardRayPattern::k_rays; ++k) {
            // Beyond 45 degrees a chord ends where the normal points the same way: Shapira's rule drops it.
            const float same_way = -std::cos(2.0F * pattern.angle[k]), length = rays.of_face(f)[k];
            if (same_way < 0.05F) {
                EXPECT_NEAR(length, 2.0F * radius * std::cos(pattern.angle[k]), 0.03F * radius);
            }
            if (same_way > 0.15F) {
                EXPECT_EQ(length, k_missed);
            }
        }
    }
}

TEST(InwardRays, OfATorusAndACylinderCrossTheTube) {
    for (const TriangleMesh& mesh : {shapes::torus(1.0F, 0.3F, 80, 40), shapes::cylinder(0.3F, 10.0F, 40, 100, true)}) {
        const PreparedMesh prepared = prepare_mesh(mesh, 200);
        const float unit = prepared.mesh.vertices[0].norm() / mesh.vertices[0].norm();  // both are centered
        const RayScene scene(prepared.mesh);
        const InwardRays rays = cast_inward_rays(prepared, scene);
        const FeatureMatrix diameter = diameter_features(prepared, rays),
                            medial = medial_features(prepared, scene, rays);
        // A tube is equally thick everywhere, but for the cylinder's ends.
        std::size_t crossing = 0, level = 0;
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            const float length = rays.of_face(f)[0];
            crossing += length != k_missed && std::abs(length - 0.6F * unit) < 0.02F * unit;
            level += column(diameter, "diameter.median@30")[f] > 0.8F && column(medial, "medial.median@30")[f] > 0.8F;
        }
        EXPECT_GT(crossing, mesh.face_count() * 9 / 10);
        EXPECT_GT(level, mesh.face_count() * 9 / 10);
    }
}

TEST(MedialFeatures, OfACubeShrinkTowardItsEdges) {
    const PreparedMesh prepared = prepare_mesh(shapes::box(1, 1, 1, 9), 200);
    const RayScene scene(prepared.mesh);
    const FeatureMatrix medial = medial_features(prepared, scene, cast_inward_rays(prepared, scene));
    const std::span<const float> values = column(medial, "medial.median@120");
    // Halfway along each side the sphere is the cube's own; toward the cube's edges it shrinks.
    std::size_t center = 0, corner = 0;
    for (std::size_t f = 0; f < prepared.face_count(); ++f) {
        if (prepared.center[f].norm() < prepared.center[center].norm()) center = f;
        if (prepared.center[f].norm() > prepared.center[corner].norm()) corner = f;
    }
    EXPECT_GT(values[center], 1.3F * values[corner]);
}

TEST(InwardRays, LeaveAnOpenMeshWithoutLength) {
    const PreparedMesh prepared = prepare_mesh(shapes::grid(8, 8, 1.0F), 200);
    for (const float length : cast_inward_rays(prepared, RayScene(prepared.mesh)).length) EXPECT_EQ(length, k_missed);
}

TEST(DiameterFeatures, CompareTheThicknessOfParts) {
    // Two slabs, one four times as thick as the other: on their broad sides the narrow cone sees the thickness.
    const TriangleMesh thick = shapes::box(2, 2, 0.4F, 8);
    const TriangleMesh both = shapes::joined(thick, shapes::translated(shapes::box(2, 2, 0.1F, 8), Vec3(3, 0, 0)));
    const PreparedMesh prepared = prepare_mesh(both, 500);
    const InwardRays rays = cast_inward_rays(prepared, RayScene(prepared.mesh));
    const float unit = std::sqrt(prepared.total_area / (2.0F * (4.0F + 4.0F) + 8.0F * 0.5F));
    for (std::size_t f = 0; f < both.face_count(); ++f) {
        if (std::abs(prepared.normal[f].z()) < 0.9F) continue;
        EXPECT_NEAR(rays.of_face(f)[0], unit * (f < thick.face_count() ? 0.4F : 0.1F), 0.01F * unit);
    }
    const MeshFeatures features = compute_features(both);
    for (const char* name : {"diameter.mean@30", "diameter.median@30", "medial.mean@30"}) {
        const std::span<const float> values = column(features.unary, name);
        const auto mean_of_broad_sides = [&](std::size_t begin, std::size_t end) {
            double sum = 0.0, count = 0.0;
            for (std::size_t f = begin; f < end; ++f) {
                if (std::abs(prepared.normal[f].z()) < 0.9F) continue;
                sum += static_cast<double>(values[f]);
                count += 1.0;
            }
            return sum / count;
        };
        const double ratio =
            mean_of_broad_sides(0, thick.face_count()) / mean_of_broad_sides(thick.face_count(), both.face_count());
        EXPECT_GT(ratio, 2.0) << name;
        EXPECT_LT(ratio, 5.0) << name;
    }
}

TEST(DiameterFeatures, LieBetweenZeroAndOneAndLogarithmsFollow) {
    const MeshFeatures features = compute_features(lopsided_torus(24, 16));
    for (const char* family : {"diameter", "medial"}) {
        for (const char* cone : {"@30", "@60", "@90", "@120"}) {
            for (const char* statistic : {".mean", ".median", ".mean_square"}) {
                const std::string name = std::string(family) + statistic + cone;
                const std::span<const float> raw = column(features.unary, name);
                const std::span<const float> log4 = column(features.unary, name + "/log4");
                EXPECT_FLOAT_EQ(*std::ranges::max_element(raw), 1.0F);
                for (std::size_t f = 0; f < raw.size(); ++f) {
                    EXPECT_GE(raw[f], 0.0F);
                    EXPECT_LE(raw[f], 1.0F);
                    EXPECT_NEAR(log4[f], std::log(4.0F * raw[f] + 1.0F) / std::log(5.0F), 1e-5F);
                }
            }
        }
    }
}

TEST(MedialFeatures, OfASphereAreConstant) {
    const MeshFeatures features = compute_features(shapes::icosphere(4, 1.0F));
    for (const char* name : {"medial.mean@30", "medial.median@120", "medial.mean_square@60", "diameter.mean@90"}) {
        for (const float value : column(features.unary, name)) EXPECT_GT(value, 0.93F) << name;
    }
}

}  // namespace
}  // namespace exemplar
