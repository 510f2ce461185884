// Boosted stumps on random features: 1200 stumps on 330 columns, 8 classes, the size of a trained classifier of
// faces.

#include <array>
#include <cstdint>
#include <string>

#include "apps/bench/kernels/operation.h"
#include "embedded/learn_stumps_comp.h"
#include "gpu/learn/stump_scorer.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_stump_classes = 8;
constexpr std::size_t k_stump_columns = 330, k_stumps = 1200;

FeatureMatrix random_features(std::size_t rows, Random& random) {
    FeatureMatrix features;
    features.rows = rows;
    features.values.reserve(rows * k_stump_columns);
    for (std::size_t c = 0; c < k_stump_columns; ++c)
        for (float& value : features.add(std::to_string(c))) value = static_cast<float>(random.normal());
    return features;
}

// Shared by 40 sets of classes.
BoostedStumps random_stumps(Random& random) {
    BoostedStumps classifier{.class_count = k_stump_classes, .stumps = {}, .elsewhere = {}};
    std::array<std::uint64_t, 40> sets;
    for (std::uint64_t& set : sets) set = 1 + random.index((1u << k_stump_classes) - 1);
    for (std::size_t m = 0; m < k_stumps; ++m)
        classifier.stumps.push_back({static_cast<std::uint32_t>(random.index(k_stump_columns)),
                                     static_cast<float>(random.normal()), static_cast<float>(random.uniform(-0.2, 0.2)),
                                     static_cast<float>(random.uniform(-0.2, 0.2)), sets[random.index(sets.size())]});
    classifier.elsewhere.assign(classifier.stumps.size() * k_stump_classes, 0.0f);
    return classifier;
}

struct Scoring {
    Scoring(Device& device, Profiler& profiler, std::size_t rows)
        : features(random_features(rows, random)),
          classifier(random_stumps(random)),
          actual(rows * k_stump_classes),
          scorer(device, &profiler) {}
    void run() { scorer.probabilities(classifier, features, Link::softmax, 1.0f, actual); }
    std::vector<Difference> differences() const {
        std::vector<float> expected(actual.size());
        CpuStumpScorer().probabilities(classifier, features, Link::softmax, 1.0f, expected);
        return {{"probabilities", largest_difference(actual, expected), 1e-5}};
    }
    // A feature is at least a byte, its rank. Per stump a comparison, a selection and a sum; per class a maximum, a
    // difference, exp, a sum and a quotient.
    std::map<std::string, Work> work() const {
        const auto rows = static_cast<double>(features.rows), stumps = static_cast<double>(k_stumps);
        return {{"learn/stumps.comp",
                 {.bytes = rows * (k_stump_columns + 4 * k_stump_classes) + 16 * stumps,
                  .operations = rows * (3 * stumps + 5 * k_stump_classes)}}};
    }
    Random random{1};
    FeatureMatrix features;
    BoostedStumps classifier;
    std::vector<float> actual;
    GpuStumpScorer scorer;
};

}  // namespace

std::vector<OperationKind> learn_operations() {
    return {{"stump scoring",
             "faces",
             {5'000, 20'000, 100'000},
             {&shaders::learn_stumps_comp},
             {k_stump_quads, k_stump_storage, k_stump_bits},
             prepare_as<Scoring>}};
}

}  // namespace exemplar
