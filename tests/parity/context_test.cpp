#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "gpu/labeling/context_histograms.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/labeling/features/context.h"
#include "tests/gpu/support/environment.h"
#include "tests/support/random_context.h"

// Both put every sample into the same bin; the device sums up to 1000 masses, 1 in all, in single precision: the error
// of a sum is far below 1000 x 6e-8, in practice about 1e-6.
namespace exemplar {
namespace {

using test_support::ContextGroup;
using test_support::expect_as_one_by_one;
using test_support::expect_context_parity;
using test_support::histogram_count;
using test_support::random_context;
using test_support::random_probabilities;

TEST(ContextParity, OddNumbersOfFaces) {
    GpuContextHistograms histograms(test_support::shared_device());
    Random random(1);
    for (const std::size_t faces : {0u, 1u, 63u, 64u, 65u, 300u}) {
        SCOPED_TRACE(faces);
        expect_context_parity(histograms, random_context(faces, faces ? 37 : 0, random), 3, random);
    }
}

TEST(ContextParity, OddNumbersOfSamples) {
    GpuContextHistograms histograms(test_support::shared_device());
    Random random(2);
    for (const std::size_t samples : {0u, 1u, 2u, 15u, 16u, 17u, 255u, 256u, 257u, 1000u}) {
        SCOPED_TRACE(samples);
        expect_context_parity(histograms, random_context(50, samples, random), 5, random);
    }
}

TEST(ContextParity, AllNumbersOfClasses) {
    GpuContextHistograms histograms(test_support::shared_device());
    Random random(3);
    const ContextGeometry geometry = random_context(66, 40, random);
    for (const std::size_t classes : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u, 9u, 16u, 17u, 64u}) {
        SCOPED_TRACE(classes);
        expect_context_parity(histograms, geometry, classes, random);
    }
}

// Neither the faces nor the classes nor, with the least limit, the samples fit at once.
TEST(ContextParity, WorkOverTheLimitsIsTiled) {
    Random random(8);
    const ContextGeometry geometry = random_context(70, 60, random);
    for (const std::size_t tile_bytes :
         {std::size_t{1}, 30 * k_context_measures * k_context_bins * 4 * sizeof(float)}) {
        GpuContextHistograms histograms(test_support::shared_device(), nullptr, tile_bytes);
        for (const std::size_t classes : {4u, 6u, 13u}) {
            SCOPED_TRACE(classes);
            expect_context_parity(histograms, geometry, classes, random);
        }
    }
}

// The second limit is that of the histograms of four classes of 30 faces.
TEST(ContextParity, MeshesOfAGroupAreDoneAsOneByOne) {
    Random random(9);
    for (const std::size_t tile_bytes :
         {std::size_t{1}, 30 * k_context_measures * k_context_bins * 4 * sizeof(float), k_context_tile_bytes})
        for (const std::size_t classes : {1u, 4u, 6u}) {
            SCOPED_TRACE(tile_bytes);
            GpuContextHistograms histograms(test_support::shared_device(), nullptr, tile_bytes);
            expect_as_one_by_one(histograms, ContextGroup(test_support::k_odd_meshes, classes, random));
            expect_as_one_by_one(histograms, ContextGroup({}, classes, random));
        }
    CpuContextHistograms reference;
    expect_as_one_by_one(reference, ContextGroup(test_support::k_odd_meshes, 5, random));
}

TEST(ContextParity, ManyMeshesAreOneSubmission) {
    Random random(10);
    Profiler profiler;
    GpuContextHistograms histograms(test_support::shared_device(), &profiler);
    for (const std::size_t count : {1u, 60u, 7u}) {
        std::vector<std::pair<std::size_t, std::size_t>> sizes;
        while (sizes.size() < count) sizes.emplace_back(1 + random.index(90), 1 + random.index(40));
        ContextGroup group(sizes, 3, random);
        profiler.reset();
        histograms.accumulate_all(group.meshes(), group.classes);
        EXPECT_EQ(profiler.submissions(), 1u);
        expect_as_one_by_one(histograms, group);
    }
}

// Room for the histograms of 200 faces: two of the meshes, then one that is too large with the next, then two.
TEST(ContextParity, AGroupOverTheLimitIsSeveralSubmissions) {
    Random random(11);
    Profiler profiler;
    GpuContextHistograms histograms(test_support::shared_device(), &profiler,
                                    200 * k_context_measures * k_context_bins * 4 * sizeof(float));
    ContextGroup group({{100, 20}, {100, 20}, {150, 20}, {60, 20}, {140, 20}}, 4, random);
    histograms.accumulate_all(group.meshes(), group.classes);
    EXPECT_EQ(profiler.submissions(), 3u);
}

// A flat mesh has no extent along an axis: all edges and distances are zero, and everything is in the last bin.
TEST(ContextParity, DegenerateAxes) {
    GpuContextHistograms histograms(test_support::shared_device());
    Random random(5);
    ContextGeometry geometry = random_context(70, 20, random);
    std::fill_n(geometry.axis_position.begin(), 70, 0.0f);
    geometry.axis_edges[0] = {0.0f, 0.0f, 0.0f, 0.0f};
    geometry.axis_edges[1] = {0.5f, 0.5f, 0.5f, 0.5f};
    expect_context_parity(histograms, geometry, 3, random);
}

// Checked against the definition: all samples of a connected mesh add up to 1 over the bins of each measure.
TEST(ContextParity, BinsOfAMeasureHoldTheWholeMass) {
    Random random(6);
    ContextGeometry geometry = random_context(65, 100, random);
    for (std::uint8_t& range : geometry.geodesic_bin) range = std::min<std::uint8_t>(range, k_context_bins - 1);
    const std::vector<float> probabilities = random_probabilities(65, 6, random);
    std::vector<float> histograms(histogram_count(65, 6));
    GpuContextHistograms(test_support::shared_device()).accumulate(geometry, probabilities, 6, histograms);
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
    const ContextGeometry good = random_context(20, 10, random);
    ContextGeometry short_geodesic = good, stray_sample = good;
    short_geodesic.geodesic_bin.pop_back();
    stray_sample.sample_face[3] = 20;
    const std::vector<float> probabilities = random_probabilities(20, 2, random);
    std::vector<float> out(histogram_count(20, 2));
    GpuContextHistograms gpu(test_support::shared_device());
    CpuContextHistograms cpu;
    for (ContextHistograms* histograms : std::initializer_list<ContextHistograms*>{&gpu, &cpu}) {
        EXPECT_THROW(histograms->accumulate(short_geodesic, probabilities, 2, out), UsageError);
        EXPECT_THROW(histograms->accumulate(stray_sample, probabilities, 2, out), UsageError);
        EXPECT_THROW(histograms->accumulate(good, probabilities, 3, out), UsageError);
        EXPECT_THROW(histograms->accumulate(good, probabilities, 2, std::span(out).first(5)), UsageError);
        std::ranges::fill(out, -1.0f);
        std::vector<float> other(out.size());
        EXPECT_THROW(
            histograms->accumulate_all(
                std::vector<ContextMesh>{{&good, probabilities, out}, {&short_geodesic, probabilities, other}}, 2),
            UsageError);
        EXPECT_TRUE(std::ranges::all_of(out, [](float value) { return value == -1.0f; }));
    }
}

}  // namespace
}  // namespace exemplar
