#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "host/core/random.h"
#include "host/labeling/features/context.h"

// Random input of contextual histograms, and what their implementations are held to.
namespace exemplar::test_support {

// Positions on a coarse grid, so that many distances fall exactly on range edges; some samples have no path.
inline ContextGeometry random_context(std::size_t faces, std::size_t samples, Random& random) {
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

inline std::vector<float> random_probabilities(std::size_t faces, std::size_t classes, Random& random) {
    std::vector<float> probabilities(faces * classes);
    for (std::size_t i = 0; i < faces; ++i) {
        float sum = 0.0f;
        for (std::size_t l = 0; l < classes; ++l)
            sum += probabilities[i * classes + l] = static_cast<float>(random.uniform());
        for (std::size_t l = 0; l < classes; ++l) probabilities[i * classes + l] /= sum;
    }
    return probabilities;
}

inline std::size_t histogram_count(std::size_t faces, std::size_t classes) {
    return k_context_measures * k_context_bins * classes * faces;
}

inline void expect_near_histograms(const std::vector<float>& actual, const std::vector<float>& expected,
                                   std::size_t faces, std::size_t classes) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const std::size_t column = i / faces;
        ASSERT_NEAR(actual[i], expected[i], 1e-5f)
            << "face " << i % faces << ", measure " << column / classes / k_context_bins << ", bin "
            << column / classes % k_context_bins << ", class " << column % classes;
        // Thresholds may lie just above zero, so empty bins are exactly empty.
        ASSERT_EQ(actual[i] == 0.0f, expected[i] == 0.0f) << "face " << i % faces << ", column " << column;
    }
}

// Expects of random probabilities what the reference says.
inline void expect_context_parity(ContextHistograms& histograms, const ContextGeometry& geometry, std::size_t classes,
                                  Random& random) {
    const std::vector<float> probabilities = random_probabilities(geometry.faces, classes, random);
    std::vector<float> expected(histogram_count(geometry.faces, classes)), actual(expected.size(), -1.0f);
    CpuContextHistograms().accumulate(geometry, probabilities, classes, expected);
    histograms.accumulate(geometry, probabilities, classes, actual);
    expect_near_histograms(actual, expected, geometry.faces, classes);
}

// Meshes of given numbers of faces and samples.
struct ContextGroup {
    std::vector<ContextGeometry> geometry;
    std::vector<std::vector<float>> probabilities, out;
    std::size_t classes;

    ContextGroup(const std::vector<std::pair<std::size_t, std::size_t>>& faces_and_samples, std::size_t class_count,
                 Random& random)
        : classes(class_count) {
        for (const auto& [faces, samples] : faces_and_samples) {
            geometry.push_back(random_context(faces, samples, random));
            probabilities.push_back(random_probabilities(faces, classes, random));
            out.emplace_back(histogram_count(faces, classes), -1.0f);
        }
    }
    std::vector<ContextMesh> meshes() {
        std::vector<ContextMesh> result;
        for (std::size_t i = 0; i < geometry.size(); ++i) result.push_back({&geometry[i], probabilities[i], out[i]});
        return result;
    }
};

// Takes the histograms of all meshes at once, and expects of each what it gets alone, and what the reference says.
inline void expect_as_one_by_one(ContextHistograms& histograms, ContextGroup group) {
    histograms.accumulate_all(group.meshes(), group.classes);
    for (std::size_t i = 0; i < group.geometry.size(); ++i) {
        SCOPED_TRACE("mesh " + std::to_string(i));
        std::vector<float> alone(group.out[i].size(), -1.0f), expected = alone;
        histograms.accumulate(group.geometry[i], group.probabilities[i], group.classes, alone);
        EXPECT_EQ(group.out[i], alone);
        CpuContextHistograms().accumulate(group.geometry[i], group.probabilities[i], group.classes, expected);
        expect_near_histograms(alone, expected, group.geometry[i].faces, group.classes);
    }
}

inline const std::vector<std::pair<std::size_t, std::size_t>> k_odd_meshes{
    {0, 0}, {1, 1}, {30, 0}, {63, 16}, {64, 15}, {65, 17}, {0, 0}, {70, 60}, {29, 33}, {30, 31}, {31, 32}, {90, 33}};

}  // namespace exemplar::test_support
