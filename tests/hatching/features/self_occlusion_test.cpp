#include "host/hatching/features/self_occlusion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// The integral over the sphere of products of all harmonics with each other: exact in the angle around, by Simpson's
/// rule in z.
std::vector<double> products_of_harmonics() {
    constexpr int k_around = 16, k_steps = 400;
    std::vector<double> sums(k_harmonics * k_harmonics);
    for (int i = 0; i <= k_steps; ++i) {
        const double z = -1 + 2.0 * i / k_steps, radius = std::sqrt(std::max(0.0, 1 - z * z));
        const double weight = (i == 0 || i == k_steps ? 1 : i % 2 ? 4 : 2) * 2.0 / (3 * k_steps);
        for (int j = 0; j < k_around; ++j) {
            const double angle = 2 * std::numbers::pi * (j + 0.3) / k_around;
            const Harmonics y =
                spherical_harmonics(shapes::detail::vec3(radius * std::cos(angle), radius * std::sin(angle), z));
            for (std::size_t a = 0; a < k_harmonics; ++a)
                for (std::size_t b = 0; b < k_harmonics; ++b)
                    sums[a * k_harmonics + b] +=
                        weight * 2 * std::numbers::pi / k_around * static_cast<double>(y[a] * y[b]);
        }
    }
    return sums;
}

// Constants have 8 digits and sums are of floats: 1e-5.
TEST(SphericalHarmonics, AreOrthonormal) {
    const std::vector<double> products = products_of_harmonics();
    for (std::size_t a = 0; a < k_harmonics; ++a)
        for (std::size_t b = 0; b < k_harmonics; ++b)
            EXPECT_NEAR(products[a * k_harmonics + b], a == b ? 1 : 0, 1e-5) << a << ", " << b;
}

// Bands turn into themselves: the sum of squares of each is the same for all directions, (2 l + 1) / (4 pi).
TEST(SphericalHarmonics, BandsHaveNoDirection) {
    for (const Vec3& direction : sphere_directions(200)) {
        const Harmonics y = spherical_harmonics(direction);
        for (std::size_t l = 0, k = 0; l < k_harmonic_bands; ++l) {
            double sum = 0;
            for (; k < (l + 1) * (l + 1); ++k) sum += static_cast<double>(y[k] * y[k]);
            EXPECT_NEAR(sum, (2.0 * static_cast<double>(l) + 1) / (4 * std::numbers::pi), 1e-5);
        }
    }
}

TEST(SphericalHarmonics, DirectionsAreSpreadEvenly) {
    const std::vector<Vec3> directions = sphere_directions(512);
    ASSERT_EQ(directions.size(), 512U);
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Vec3d sum = Vec3d::Zero();
    for (const Vec3& d : directions) {
        EXPECT_NEAR(d.norm(), 1, 1e-6);
        sum += d.cast<double>() / 512;
        moments += d.cast<double>() * d.cast<double>().transpose() / 512;
    }
    EXPECT_LT(sum.norm(), 1e-3);
    EXPECT_LT((moments - Eigen::Matrix3d::Identity() / 3).norm(), 1e-3);
}

/// How bright harmonics make an open surface that a light meets at an angle of this cosine: the zonal harmonics of a
/// clamped cosine, windowed as the light is.
double brightness(double cosine) {
    const double x = cosine, cosines[] = {std::numbers::pi, 2 * std::numbers::pi / 3, std::numbers::pi / 4, 0,
                                          -std::numbers::pi / 24};
    const double legendre[] = {1, x, 1.5 * x * x - 0.5, 0, (35 * x * x * x * x - 30 * x * x + 3) / 8};
    double sum = 0, straight = 0;
    for (std::size_t l = 0; l < 5; ++l) {
        const double part = 0.5 * (1 + std::cos(std::numbers::pi * static_cast<double>(l) / 5)) * cosines[l] *
                            (2.0 * static_cast<double>(l) + 1);
        sum += part * legendre[l];
        straight += part;
    }
    return std::clamp(sum / straight, 0.0, 1.0);
}

// That of an open surface leaves max(0, L.N) by less than 0.17, most where the light grazes; it never falls when the
// light rises.
TEST(SelfOcclusion, LightOfFewHarmonicsIsNearlyLambertian) {
    double last = 0;
    for (int i = -100; i <= 100; ++i) {
        const double cosine = i / 100.0, bright = brightness(cosine);
        EXPECT_NEAR(bright, std::max(cosine, 0.0), 0.17) << cosine;
        EXPECT_GE(bright, last - 1e-9);
        last = bright;
    }
    EXPECT_NEAR(brightness(1), 1, 1e-12);
    EXPECT_EQ(brightness(-1), 0);
}

// 512 rays sum what the integral has to within 0.02.
TEST(SelfOcclusion, AConvexSurfaceHidesNothing) {
    const TriangleMesh mesh = shapes::icosphere(3, 2.5f);
    std::vector<Vec3> normals;
    for (const Vec3& v : mesh.vertices) normals.push_back(v.normalized());
    const SelfOcclusion occlusion = measure_self_occlusion(mesh, normals);
    for (const float ambient : occlusion.ambient) EXPECT_EQ(ambient, 1);
    for (const Vec3& light : {Vec3(0, 0, 1), Vec3(1, -2, 0.5f)}) {
        const Vec3 unit = light.normalized();
        const std::vector<float> bright = shade(occlusion, unit);
        for (std::size_t v = 0; v < bright.size(); ++v)
            EXPECT_NEAR(bright[v], brightness(static_cast<double>(unit.dot(normals[v]))), 0.02) << v;
    }
}

// Where light falls in straight, what arrives has its direction; on the far side next to nothing arrives.
TEST(SelfOcclusion, VectorIrradiancePointsToTheLight) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const SelfOcclusion occlusion = measure_self_occlusion(mesh, mesh.vertices, 4096);
    for (const std::size_t v : {0u, 77u, 300u}) {
        const Vec3 light = mesh.vertices[v];
        const std::vector<Vec3> irradiance = vector_irradiance(occlusion, light);
        EXPECT_GT(irradiance[v].normalized().dot(light), std::cos(0.02f));
        for (std::size_t other = 0; other < irradiance.size(); ++other) {
            EXPECT_LE(irradiance[other].norm(), 1.05f * irradiance[v].norm());
            if (mesh.vertices[other].dot(light) < -0.9f) {
                EXPECT_LT(irradiance[other].norm(), 0.05f * irradiance[v].norm());
            }
        }
    }
}

/// A round pit of radius 1, open at the top; vertex 0 is the middle of its floor.
TriangleMesh pit(float depth) {
    TriangleMesh mesh = shapes::cylinder(1, depth, 64, 4, true);
    const auto bottom = static_cast<std::uint32_t>(mesh.vertex_count() - 2), top = bottom + 1;
    std::erase_if(mesh.faces, [&](const Face& face) { return face[0] == top; });
    for (Face& face : mesh.faces) {
        std::swap(face[1], face[2]);
        for (std::uint32_t& corner : face) corner = corner == bottom ? 0 : corner == 0 ? bottom : corner;
    }
    std::swap(mesh.vertices[0], mesh.vertices[bottom]);
    mesh.vertices.pop_back();
    return mesh;
}

// Of an evenly bright sky a disk seen under half angle alpha gives the share sin^2 alpha = 1 / (1 + depth^2); 2048 rays
// above tell it to within 0.02.
TEST(SelfOcclusion, APitIsAsDarkAsItIsDeep) {
    for (const float depth : {0.5f, 1.0f, 2.0f, 6.0f}) {
        const TriangleMesh mesh = pit(depth);
        const SelfOcclusion occlusion = measure_self_occlusion(mesh, vertex_normals(mesh), 4096);
        EXPECT_NEAR(occlusion.ambient[0], 1 / (1 + depth * depth), 0.02f) << depth;
        const float above = shade(occlusion, Vec3::UnitZ())[0];
        const float aside = shade(occlusion, Vec3(std::sin(1.2f), 0, std::cos(1.2f)))[0];
        EXPECT_LT(aside, above) << depth;
        if (depth < 2) continue;
        EXPECT_LT(aside, 0.1f);
        // What arrives comes from above.
        const Vec3 irradiance = vector_irradiance(occlusion, Vec3::UnitZ())[0];
        EXPECT_GT(irradiance.normalized().z(), 0.999f);
    }
}

}  // namespace
}  // namespace exemplar
