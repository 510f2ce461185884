#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <vector>

#include "host/core/random.h"
#include "host/core/stopwatch.h"
#include "host/graphcut/alpha_expansion.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/boosting/jointboost.h"
#include "host/learn/boosting/quantize.h"

namespace exemplar {
namespace {

struct Data {
    FeatureMatrix features;
    std::vector<std::int32_t> labels;
    std::vector<float> areas;
};

/// Overlapping classes; `sparse` is the share of zeros (histogram features are mostly zero).
Data make_data(std::size_t rows, std::size_t cols, std::size_t classes, double sparse) {
    Random random(1);
    Data data;
    data.features.rows = rows;
    for (std::size_t i = 0; i < rows; ++i) {
        data.labels.push_back(static_cast<std::int32_t>(random.index(classes)));
        data.areas.push_back(static_cast<float>(random.uniform(0.1, 1.0)));
    }
    data.features.values.reserve(rows * cols);
    for (std::size_t f = 0; f < cols; ++f) {
        const double spread = random.uniform(0.0, 0.5);
        const std::span<float> column = data.features.add(fmt::format("f{}", f));
        for (std::size_t i = 0; i < rows; ++i) {
            const std::size_t center = (static_cast<std::size_t>(data.labels[i]) * 7 + f) % classes;
            const double value = random.normal() + spread * static_cast<double>(center);
            column[i] = random.uniform() < sparse ? 0.0f : static_cast<float>(value);
        }
    }
    return data;
}

void quantize_features(benchmark::State& state) {
    const Data data = make_data(60'000, 100, 8, 0.3);
    for (auto _ : state) benchmark::DoNotOptimize(quantize(data.features, data.areas, {}).bins.data());
    state.SetItemsProcessed(state.iterations() * 60'000 * 100);
}
BENCHMARK(quantize_features)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// Arguments: classes, rounds, percent of zeros; 60,000 rows x 650 features.
void jointboost(benchmark::State& state) {
    constexpr std::size_t k_rows = 60'000, k_cols = 650;
    const auto classes = static_cast<std::size_t>(state.range(0));
    const Data data = make_data(k_rows, k_cols, classes, static_cast<double>(state.range(2)) / 100.0);
    const QuantizedFeatures quantized = quantize(data.features, data.areas, {});
    BoostOptions options;
    options.rounds = static_cast<std::size_t>(state.range(1));
    const Stopwatch watch;
    for (auto _ : state) {
        train_jointboost({quantized, data.labels, data.areas, {}}, classes, options);
    }
    const double cpu = watch.cpu() / static_cast<double>(state.iterations() * options.rounds);
    state.counters["cpu_s_per_round"] = cpu;
    state.counters["cpu_ns_per_value"] = 1e9 * cpu / static_cast<double>(k_rows * k_cols);
}
BENCHMARK(jointboost)
    ->Args({8, 20, 30})
    ->Args({8, 20, 90})
    ->Args({6, 20, 30})
    ->Args({12, 10, 30})
    ->Args({8, 300, 30})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void gentleboost(benchmark::State& state) {
    const Data data = make_data(90'000, 191, 2, 0.3);
    const QuantizedFeatures quantized = quantize(data.features, data.areas, {});
    BoostOptions options;
    options.rounds = 20;
    for (auto _ : state) train_gentleboost({quantized, data.labels, data.areas, {}}, options);
}
BENCHMARK(gentleboost)->Iterations(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void score_stumps(benchmark::State& state) {
    const Data data = make_data(20'000, 100, 8, 0.3);
    const QuantizedFeatures quantized = quantize(data.features, data.areas, {});
    BoostOptions options;
    options.rounds = 100;
    const BoostResult model = train_jointboost({quantized, data.labels, data.areas, {}}, 8, options);
    std::vector<float> out(20'000 * 8);
    CpuStumpScorer scorer;
    for (auto _ : state) scorer.probabilities(model.classifier, data.features, Link::softmax, 1.0f, out);
}
BENCHMARK(score_stumps)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

/// A grid of hexagonal connectivity (three neighbors, as faces of a mesh have) with smooth, noisy unary costs.
/// Arguments: the heaviest edge in tenths; width and height of the grid.
void expand_labels(benchmark::State& state) {
    constexpr std::uint32_t k_labels = 8;
    const auto width = static_cast<std::uint32_t>(state.range(1)), height = static_cast<std::uint32_t>(state.range(2));
    Random random(1);
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<float> unary;
    for (std::uint32_t i = 0; i < width * height; ++i) {
        const std::uint32_t x = i % width, y = i / width, truth = x * 4 / width + 4 * (y * 2 / height);
        for (std::uint32_t l = 0; l < k_labels; ++l) {
            unary.push_back(static_cast<float>((l == truth ? 0.0 : 1.0) + 2.0 * random.uniform()));
        }
        if (x + 1 < width) edges.push_back({i, i + 1});
        if (y + 1 < height && (x + y) % 2 == 0) edges.push_back({i, i + width});
    }
    std::vector<double> weight(edges.size()), v(k_labels * k_labels, 1.0);
    for (double& w : weight) w = random.uniform(0.1, static_cast<double>(state.range(0)) / 10.0);
    for (std::size_t l = 0; l < k_labels; ++l) v[l * k_labels + l] = 0.0;
    for (auto _ : state) {
        const ExpansionResult result = alpha_expansion(unary, k_labels, edges, weight, v);
        state.counters["sweeps"] = static_cast<double>(result.sweeps);
        state.counters["edges"] = static_cast<double>(edges.size());
    }
}
BENCHMARK(expand_labels)
    ->Args({5, 200, 100})
    ->Args({20, 200, 100})
    ->Args({5, 500, 200})
    ->Args({20, 500, 200})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

}  // namespace
}  // namespace exemplar
