// The kernels of labeling (see kernel_bench.h).

#include "apps/bench/kernel_bench.h"

#include <array>
#include <cstdint>
#include <string>

#include "gpu/labeling/context_histograms.h"
#include "gpu/learn/stump_scorer.h"
#include "host/core/random.h"
#include "host/labeling/fast_context.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_classes = 8;

FeatureMatrix random_features(std::size_t rows, std::size_t columns, Random& random) {
    FeatureMatrix features;
    features.rows = rows;
    features.values.reserve(rows * columns);
    for (std::size_t c = 0; c < columns; ++c)
        for (float& value : features.add(std::to_string(c))) value = static_cast<float>(random.normal());
    return features;
}

// 300 stumps on 150 of the features, shared by 40 sets of classes: the size of a trained classifier.
BoostedStumps random_stumps(std::size_t columns, Random& random) {
    BoostedStumps classifier{.class_count = k_classes, .stumps = {}, .elsewhere = {}};
    std::array<std::uint64_t, 40> sets;
    for (std::uint64_t& set : sets) set = 1 + random.index((1u << k_classes) - 1);
    for (std::size_t m = 0; m < 300; ++m)
        classifier.stumps.push_back({static_cast<std::uint32_t>(random.index(columns)),
                                     static_cast<float>(random.normal()), static_cast<float>(random.uniform(-0.2, 0.2)),
                                     static_cast<float>(random.uniform(-0.2, 0.2)), sets[random.index(sets.size())]});
    classifier.elsewhere.assign(classifier.stumps.size() * k_classes, 0.0f);
    return classifier;
}

void score_stumps(benchmark::State& state) {
    constexpr std::size_t k_columns = 150;
    Random random(1);
    const FeatureMatrix features = random_features(static_cast<std::size_t>(state.range(0)), k_columns, random);
    const BoostedStumps classifier = random_stumps(k_columns, random);
    std::vector<float> expected(features.rows * k_classes), actual(expected.size());
    CpuStumpScorer reference;
    const double reference_ms =
        reference_cpu([&] { reference.probabilities(classifier, features, Link::softmax, 1.0f, expected); });
    Profiler profiler;
    GpuStumpScorer scorer(bench().device, &profiler);
    const auto call = [&] { scorer.probabilities(classifier, features, Link::softmax, 1.0f, actual); };
    call();
    if (!verified(state, actual, expected)) return;

    const auto rows = static_cast<double>(features.rows), stumps = static_cast<double>(classifier.stumps.size());
    // Per stump a comparison, a selection and a sum; per class a maximum, a difference, exp, a sum and a quotient.
    time_call(
        state, profiler,
        {.bytes = 4 * rows * (k_columns + k_classes) + 16 * stumps, .operations = rows * (3 * stumps + 5 * k_classes)},
        call);
    state.counters["reference_cpu"] = reference_ms;
}
BENCHMARK(score_stumps)->Apply(three_sizes);

ContextGeometry random_geometry(std::size_t faces, std::size_t samples, Random& random) {
    ContextGeometry geometry;
    geometry.faces = faces;
    for (std::size_t j = 0; j < samples; ++j)
        geometry.sample_face.push_back(static_cast<std::uint32_t>(random.index(faces)));
    geometry.sample_area.assign(samples, 1.0f / static_cast<float>(samples));
    geometry.geodesic_bin.resize(samples * faces);
    for (std::uint8_t& bin : geometry.geodesic_bin) bin = static_cast<std::uint8_t>(random.next() % k_context_bins);
    geometry.axis_position.resize(k_context_axes * faces);
    for (float& position : geometry.axis_position) position = static_cast<float>(random.uniform(0.0, 2.0));
    for (auto& edges : geometry.axis_edges) edges = {0.2f, 0.5f, 0.95f, 1.5f};
    return geometry;
}

void context_histograms(benchmark::State& state) {
    constexpr std::size_t k_samples = 1000;
    const auto face_count = static_cast<std::size_t>(state.range(0));
    Random random(2);
    const ContextGeometry geometry = random_geometry(face_count, k_samples, random);
    const std::vector<float> probabilities(face_count * k_classes, 1.0f / k_classes);
    constexpr std::size_t k_columns = k_context_measures * k_context_bins * k_classes;
    std::vector<float> expected(k_columns * face_count), actual(expected.size());
    CpuContextHistograms reference;
    const double reference_ms =
        reference_cpu([&] { reference.accumulate(geometry, probabilities, k_classes, expected); });
    FastContextHistograms host;
    const double host_ms = reference_cpu([&] { host.accumulate(geometry, probabilities, k_classes, actual); });
    if (!verified(state, actual, expected)) return;
    Profiler profiler;
    GpuContextHistograms histograms(bench().device, &profiler);
    const auto call = [&] { histograms.accumulate(geometry, probabilities, k_classes, actual); };
    call();
    if (!verified(state, actual, expected)) return;

    // Geodesic ranges: a sum per sample and class. Axes: two binary searches per inner edge, three sums per bin and
    // class.
    const auto faces = static_cast<double>(face_count);
    const double searches = k_context_axes * 2 * (k_context_bins - 1) * std::log2(k_samples);
    time_call(state, profiler,
              {.bytes = faces * (k_samples + 4 * k_context_axes + 4 * k_columns),
               .operations =
                   faces * (k_samples * k_classes + 2 * searches + k_context_axes * k_context_bins * k_classes * 3)},
              call);
    state.counters["reference_cpu"] = reference_ms;
    state.counters["host_cpu"] = host_ms;
}
BENCHMARK(context_histograms)->Apply(three_sizes);

// A batch of generated shapes: meshes of 5,000 faces, scored together (argument 1) or one by one (0). Wall time of a
// call for all of them; call_cpu is that of this process.
constexpr std::size_t k_batch = 8, k_batch_faces = 5'000;

template <typename Together, typename OneByOne>
void time_batch(benchmark::State& state, Profiler& profiler, Together&& together, OneByOne&& one_by_one) {
    const auto call = [&] { state.range(0) == 1 ? together() : one_by_one(); };
    call();
    profiler.reset();
    const Stopwatch watch;
    for (auto _ : state) call();
    const auto calls = static_cast<double>(state.iterations());
    double device_ms = 0.0;
    for (const auto& [kernel, entry] : profiler.entries()) device_ms += entry.milliseconds;
    state.counters["call_cpu"] = 1e3 * watch.cpu() / calls;
    state.counters["device"] = device_ms / calls;
    state.counters["submissions"] = static_cast<double>(profiler.submissions()) / calls;
}

void score_batch(benchmark::State& state) {
    constexpr std::size_t k_columns = 150;
    Random random(3);
    const BoostedStumps classifier = random_stumps(k_columns, random);
    std::vector<FeatureMatrix> features;
    std::vector<std::vector<float>> out(k_batch, std::vector<float>(k_batch_faces * k_classes));
    for (std::size_t i = 0; i < k_batch; ++i) features.push_back(random_features(k_batch_faces, k_columns, random));
    std::vector<ScoredMatrix> matrices;
    for (std::size_t i = 0; i < k_batch; ++i) matrices.push_back({&features[i], out[i]});
    Profiler profiler;
    GpuStumpScorer scorer(bench().device, &profiler);
    time_batch(
        state, profiler, [&] { scorer.probabilities_of_all(classifier, Link::softmax, 1.0f, matrices); },
        [&] {
            for (const ScoredMatrix& matrix : matrices)
                scorer.probabilities(classifier, *matrix.features, Link::softmax, 1.0f, matrix.out);
        });
}
BENCHMARK(score_batch)->Arg(0)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

void context_batch(benchmark::State& state) {
    Random random(4);
    std::vector<ContextGeometry> geometry;
    for (std::size_t i = 0; i < k_batch; ++i) geometry.push_back(random_geometry(k_batch_faces, 1000, random));
    const std::vector<float> probabilities(k_batch_faces * k_classes, 1.0f / k_classes);
    std::vector<std::vector<float>> out(
        k_batch, std::vector<float>(k_context_measures * k_context_bins * k_classes * k_batch_faces));
    std::vector<ContextMesh> meshes;
    for (std::size_t i = 0; i < k_batch; ++i) meshes.push_back({&geometry[i], probabilities, out[i]});
    Profiler profiler;
    GpuContextHistograms histograms(bench().device, &profiler);
    time_batch(
        state, profiler, [&] { histograms.accumulate_all(meshes, k_classes); },
        [&] {
            for (const ContextMesh& mesh : meshes)
                histograms.accumulate(*mesh.geometry, mesh.probabilities, k_classes, mesh.out);
        });
}
BENCHMARK(context_batch)->Arg(0)->Arg(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace exemplar
