#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "host/core/random.h"
#include "host/learn/boosting/jointboost.h"
#include "host/learn/boosting/quantize.h"

namespace exemplar {

/// Labeled rows with float features, their bins and weights.
struct Data {
    FeatureMatrix features;
    QuantizedFeatures quantized;
    std::vector<std::int32_t> labels;
    std::vector<float> weights;
    std::size_t classes = 0;

    TrainingSet training(std::span<const std::uint32_t> rows = {}) const { return {quantized, labels, weights, rows}; }
};

/// Features that each tell some classes apart, with noise of the given spread.
inline Data make_data(std::size_t rows, std::size_t cols, std::size_t classes, double noise, std::uint64_t seed) {
    Random random(seed);
    Data data;
    data.classes = classes;
    data.features.rows = rows;
    for (std::size_t i = 0; i < rows; ++i) {
        data.labels.push_back(static_cast<std::int32_t>(random.index(classes)));
        data.weights.push_back(static_cast<float>(random.uniform(0.2, 2.0)));
    }
    Random centers(17);  // the same for every seed, so that data of two seeds are two samples of one problem
    for (std::size_t f = 0; f < cols; ++f) {
        std::vector<double> center(classes);
        for (double& value : center) value = static_cast<double>(centers.index(3));
        const std::span<float> column = data.features.add(fmt::format("f{}", f));
        for (std::size_t i = 0; i < rows; ++i) {
            column[i] = static_cast<float>(center[static_cast<std::size_t>(data.labels[i])] + noise * random.normal());
        }
    }
    data.quantized = quantize(data.features, data.weights, {32});
    return data;
}

/// The k_c of stump m.
inline std::span<const float> constants(const BoostedStumps& classifier, std::size_t m) {
    return std::span(classifier.elsewhere).subspan(m * classifier.class_count, classifier.class_count);
}

inline double training_accuracy(const BoostedStumps& classifier, const Data& data) {
    std::vector<float> p(data.labels.size() * data.classes);
    CpuStumpScorer().probabilities(classifier, data.features, Link::softmax, 1.0f, p);
    double right = 0.0;
    for (std::size_t i = 0; i < data.labels.size(); ++i) {
        const auto row = p.begin() + static_cast<std::ptrdiff_t>(i * data.classes);
        right += std::max_element(row, row + static_cast<std::ptrdiff_t>(data.classes)) - row == data.labels[i];
    }
    return right / static_cast<double>(data.labels.size());
}

}  // namespace exemplar
