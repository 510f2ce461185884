#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "gpu/labeling/context_histograms.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/labeling/context.h"
#include "tests/gpu/support/environment.h"

// Both put every sample into the same bin; the device sums up to 1000 masses, 1 in all, in single precision: the error
// of a sum is far below 1000 x 6e-8, in practice about 1e-6.
namespace exemplar {
namespace {

constexpr float k_tolerance = 1e-5f;

// Positions on a coarse grid, so that many distances fall exactly on range edges; some samples have no path.
ContextGeometry random_geometry(std::size_t faces, std::size_t samples, Random& random) {
    ContextGeometry geometry;
    geometry.faces = faces;
    const auto grid = [&] { return static_cast<float>(random.index(41)) * 0.05f; };
    const auto range = [&] { return static_cast<std::uint8_t>(random.index(k_context_bins)); };
    for (std::size_t j = 0; j < samples; ++j)
        geometry.sample_face.push_back(static_cast<std::uint32_t>(random.index(faces)));
    geometry.sample_area.assign(samples, 1.0f / static_cast<float>(samples));
    for (std::size_t i = 0; i < samples * faces; ++i)
        geometry.geodesic_bin.push_back(random.uniform() < 0.1 ? k_no_bin : range());
    for (std::size_t i = 0; i < k_context_axes * faces; ++i)
        geometry.axis_position.push_back(random.uniform() < 0.5 ? grid()
                                                                : static_cast<float>(random.uniform(0.0, 2.0)));
    for (auto& edges : geometry.axis_edges) edges = {0.2f, 0.5f, 0.95f, 1.5f};
    return geometry;
}

std::vector<float> random_probabilities(std::size_t faces, std::size_t classes, Random& random) {
    std::vector<float> probabilities(faces * classes);
    for (std::size_t i = 0; i < faces; ++i) {
        float sum = 0.0f;
        for (std::size_t l = 0; l < classes; ++l)
            sum += probabilities[i * classes + l] = static_cast<float>(random.uniform());
        for (std::size_t l = 0; l < classes; ++l) probabilities[i * classes + l] /= sum;
    }
    return probabilities;
}

std::size_t output_size(std::size_t faces, std::size_t classes) {
    return k_context_measures * k_context_bins * classes * faces;
}

void expect_near(const std::vector<float>& actual, const std::vector<float>& expected, std::size_t faces,
                 std::size_t classes) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const std::size_t column = i / faces;
        ASSERT_NEAR(actual[i], expected[i], k_tolerance)
            << "face " << i % faces << ", measure " << column / classes / k_context_bins << ", bin "
            << column / classes % k_context_bins << ", class " << column % classes;
        // Thresholds may lie just above zero, so empty bins are exactly empty.
        ASSERT_EQ(actual[i] == 0.0f, expected[i] == 0.0f) << "face " << i % faces << ", column " << column;
    }
}

void expect_parity(GpuContextHistograms& device, const ContextGeometry& geometry, std::size_t classes, Random& random) {
    const std::vector<float> probabilities = random_probabilities(geometry.faces, classes, random);
    std::vector<float> expected(output_size(geometry.faces, classes)), actual(expected.size(), -1.0f);
    CpuContextHistograms().accumulate(geometry, probabilities, classes, expected);
    device.accumulate(geometry, probabilities, classes, actual);
    expect_near(actual, expected, geometry.faces, classes);
}

TEST(ContextParity, OddNumbersOfFaces) {
    GpuContextHistograms histograms(testing::shared_device());
    Random random(1);
    for (const std::size_t faces : {0u, 1u, 63u, 64u, 65u, 300u}) {
        SCOPED_TRACE(faces);
        expect_parity(histograms, random_geometry(faces, faces ? 37 : 0, random), 3, random);
    }
}

TEST(ContextParity, OddNumbersOfSamples) {
    GpuContextHistograms histograms(testing::shared_device());
    Random random(2);
    for (const std::size_t samples : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 1000u}) {
        SCOPED_TRACE(samples);
        expect_parity(histograms, random_geometry(50, samples, random), 5, random);
    }
}

TEST(ContextParity, AllNumbersOfClasses) {
    GpuContextHistograms histograms(testing::shared_device());
    Random random(3);
    const ContextGeometry geometry = random_geometry(66, 40, random);
    for (const std::size_t classes : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 16u, 17u, 64u}) {
        SCOPED_TRACE(classes);
        expect_parity(histograms, geometry, classes, random);
    }
}

// Neither the faces nor the classes nor, with the least limit, the samples fit at once.
TEST(ContextParity, WorkOverTheLimitsIsTiled) {
    Random random(8);
    const ContextGeometry geometry = random_geometry(70, 60, random);
    for (const std::size_t tile_bytes :
         {std::size_t{1}, 30 * k_context_measures * k_context_bins * 4 * sizeof(float)}) {
        GpuContextHistograms histograms(testing::shared_device(), nullptr, tile_bytes);
        for (const std::size_t classes : {4u, 6u, 13u}) {
            SCOPED_TRACE(classes);
            expect_parity(histograms, geometry, classes, random);
        }
    }
}

// A flat mesh has no extent along an axis: all edges and distances are zero, and everything is in the last bin.
TEST(ContextParity, DegenerateAxes) {
    GpuContextHistograms histograms(testing::shared_device());
    Random random(5);
    ContextGeometry geometry = random_geometry(70, 20, random);
    std::fill_n(geometry.axis_position.begin(), 70, 0.0f);
    geometry.axis_edges[0] = {0.0f, 0.0f, 0.0f, 0.0f};
    geometry.axis_edges[1] = {0.5f, 0.5f, 0.5f, 0.5f};
    expect_parity(histograms, geometry, 3, random);
}

// Checked against the definition: all samples of a connected mesh add up to 1 over the bins of each measure.
TEST(ContextParity, BinsOfAMeasureHoldTheWholeMass) {
    Random random(6);
    ContextGeometry geometry = random_geometry(65, 100, random);
    for (std::uint8_t& range : geometry.geodesic_bin) range = std::min<std::uint8_t>(range, k_context_bins - 1);
    const std::vector<float> probabilities = random_probabilities(65, 6, random);
    std::vector<float> histograms(output_size(65, 6));
    GpuContextHistograms(testing::shared_device()).accumulate(geometry, probabilities, 6, histograms);
    for (std::size_t measure = 0; measure < k_context_measures; ++measure)
        for (std::size_t face = 0; face < 65; ++face) {
            float sum = 0.0f;
            for (std::size_t column = 0; column < k_context_bins * 6; ++column)
                sum += histograms[(measure * k_context_bins * 6 + column) * 65 + face];
            ASSERT_NEAR(sum, 1.0f, 1e-4f);
        }
}

TEST(ContextParity, RefusesContradictions) {
    Random random(7);
    const ContextGeometry good = random_geometry(20, 10, random);
    ContextGeometry short_geodesic = good, stray_sample = good;
    short_geodesic.geodesic_bin.pop_back();
    stray_sample.sample_face[3] = 20;
    const std::vector<float> probabilities = random_probabilities(20, 2, random);
    std::vector<float> out(output_size(20, 2));
    GpuContextHistograms gpu(testing::shared_device());
    CpuContextHistograms cpu;
    for (ContextHistograms* histograms : std::initializer_list<ContextHistograms*>{&gpu, &cpu}) {
        EXPECT_THROW(histograms->accumulate(short_geodesic, probabilities, 2, out), UsageError);
        EXPECT_THROW(histograms->accumulate(stray_sample, probabilities, 2, out), UsageError);
        EXPECT_THROW(histograms->accumulate(good, probabilities, 3, out), UsageError);
        EXPECT_THROW(histograms->accumulate(good, probabilities, 2, std::span(out).first(5)), UsageError);
    }
}

}  // namespace
}  // namespace exemplar
