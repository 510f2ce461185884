#include "host/labeling/features/fast_context.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "tests/support/random_context.h"

// The reference sums in double precision; up to 2,500 masses, 1 in all, are summed in single precision here, as a
// shader does: within 1e-5.
namespace exemplar {
namespace {

using test_support::ContextGroup;
using test_support::expect_context_parity;
using test_support::histogram_count;
using test_support::random_context;
using test_support::random_probabilities;

TEST(FastContext, OddNumbersOfFaces) {
    FastContextHistograms histograms;
    Random random(1);
    for (const std::size_t faces : {0U, 1U, 2U, 63U, 64U, 65U, 127U, 128U, 129U, 300U}) {
        SCOPED_TRACE(faces);
        expect_context_parity(histograms, random_context(faces, faces ? 37 : 0, random), 3, random);
    }
}

TEST(FastContext, OddNumbersOfSamples) {
    FastContextHistograms histograms;
    Random random(2);
    for (const std::size_t samples : {0U, 1U, 2U, 3U, 4U, 7U, 8U, 9U, 1023U, 1024U, 1025U, 2500U}) {
        SCOPED_TRACE(samples);
        expect_context_parity(histograms, random_context(70, samples, random), 5, random);
    }
}

TEST(FastContext, AllNumbersOfClasses) {
    FastContextHistograms histograms;
    Random random(3);
    const ContextGeometry geometry = random_context(66, 40, random);
    for (std::size_t classes = 1; classes <= 64; ++classes) {
        SCOPED_TRACE(classes);
        expect_context_parity(histograms, geometry, classes, random);
    }
}

TEST(FastContext, MeshesOfAGroupAreDoneAsOneByOne) {
    FastContextHistograms histograms;
    Random random(4);
    for (const std::size_t classes : {1U, 5U, 9U})
        expect_as_one_by_one(histograms, ContextGroup(test_support::k_odd_meshes, classes, random));
    expect_as_one_by_one(histograms, ContextGroup({}, 2, random));
}

// A flat mesh has no extent along an axis: all edges and distances are zero, and everything is in the last bin.
TEST(FastContext, DegenerateAxes) {
    FastContextHistograms histograms;
    Random random(5);
    ContextGeometry geometry = random_context(70, 20, random);
    std::fill_n(geometry.axis_position.begin(), 70, 0.0F);
    geometry.axis_edges[0] = {0.0F, 0.0F, 0.0F, 0.0F};
    geometry.axis_edges[1] = {0.5F, 0.5F, 0.5F, 0.5F};
    geometry.axis_edges[2] = {0.0F, 0.0F, 0.5F, std::numeric_limits<float>::infinity()};
    expect_context_parity(histograms, geometry, 3, random);
}

// Of a face that is nowhere, no distance reaches an edge.
TEST(FastContext, FacesWithoutPosition) {
    FastContextHistograms histograms;
    Random random(6);
    ContextGeometry geometry = random_context(70, 20, random);
    for (std::uint32_t& face : geometry.sample_face) face = std::max(face, 3U);
    for (std::size_t axis = 0; axis < k_context_axes; ++axis) {
        float* const positions = geometry.axis_position.data() + axis * geometry.faces;
        positions[0] = std::numeric_limits<float>::quiet_NaN();
        positions[1] = std::numeric_limits<float>::infinity();
        positions[2] = -std::numeric_limits<float>::infinity();
    }
    expect_context_parity(histograms, geometry, 3, random);
}

TEST(FastContext, DoesNotDependOnTheNumberOfThreads) {
    FastContextHistograms histograms;
    Random random(7);
    const ContextGeometry geometry = random_context(700, 300, random);
    const std::vector<float> probabilities = random_probabilities(700, 9, random);
    std::vector<float> on_all(histogram_count(700, 9)), on_one = on_all;
    histograms.accumulate(geometry, probabilities, 9, on_all);
    const ThreadLimit one(1);
    histograms.accumulate(geometry, probabilities, 9, on_one);
    EXPECT_EQ(on_all, on_one);
}

TEST(FastContext, RefusesContradictions) {
    FastContextHistograms histograms;
    Random random(8);
    const ContextGeometry good = random_context(20, 10, random);
    ContextGeometry stray_sample = good;
    stray_sample.sample_face[3] = 20;
    const std::vector<float> probabilities = random_probabilities(20, 2, random);
    std::vector<float> out(histogram_count(20, 2), -1.0F), other(out.size());
    EXPECT_THROW(histograms.accumulate(good, probabilities, 3, out), UsageError);
    EXPECT_THROW(histograms.accumulate_all(
                     std::vector<ContextMesh>{{&good, probabilities, out}, {&stray_sample, probabilities, other}}, 2),
                 UsageError);
    EXPECT_TRUE(std::ranges::all_of(out, [](float value) { return value == -1.0F; }));
}

}  // namespace
}  // namespace exemplar
