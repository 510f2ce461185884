// The rows of `exemplar bench` on one operation each: boosting, stump scoring, the cut.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "apps/exemplar/bench/bench_data.h"
#include "apps/exemplar/bench/bench_rows.h"
#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/device/device.h"
#include "host/core/errors.h"
#include "host/learn/boosting/jointboost.h"
#include "host/learn/boosting/quantize.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_features = 650, k_classes = 8, k_stumps = 300;

Cost per_call(Cost cost, std::size_t calls) {
    cost.wall /= static_cast<double>(calls);
    cost.cpu /= static_cast<double>(calls);
    return cost;
}

/// Adds shares of the device's ceilings: the minimum memory traffic and arithmetic, per second of device time.
void add_shares(const BoostedStumps& classifier, std::size_t rows, double device_seconds, const Ceilings& ceilings,
                BenchRow& result) {
    std::set<std::uint32_t> used;
    for (const Stump& stump : classifier.stumps) used.insert(stump.feature);
    const auto items = static_cast<double>(rows), stumps = static_cast<double>(k_stumps);
    // A feature is a byte at least, as its rank is.
    const double bytes = items * static_cast<double>(used.size() + 4 * k_classes) + 16 * stumps;
    // Per stump a comparison, a selection and a sum; per class a maximum, a difference, exp, a sum and a quotient.
    const double operations = items * (3 * stumps + 5 * static_cast<double>(k_classes));
    const double copy = 1e-9 * bytes / device_seconds / ceilings.copy_gb_per_s;
    const double fma = 1e-9 * operations / device_seconds / ceilings.fma_gflop_per_s;
    result.remarks.push_back(
        fmt::format("kernel {:.1f} ms: {:.1f} % of the copy ceiling, {:.1f} % of the multiply-add "
                    "ceiling ({} of {} columns used)",
                    1e3 * device_seconds, 100 * copy, 100 * fma, used.size(), k_features));
    result.numbers["kernel_seconds"] = device_seconds;
    result.numbers["share_of_copy"] = copy;
    result.numbers["share_of_multiply_add"] = fma;
}

CutProblem cut_problem(std::size_t faces) {
    // A quarter of the faces, refined: the generator takes long for large shapes.
    return make_cut_problem(refine(make_shape("fourleg", 1, faces / 4).mesh, 1), k_classes);
}

void bench_cut_of(std::size_t faces, const std::string& others, BenchContext& context,
                  const std::function<void(const BenchRow&)>& row) {
    const CutProblem problem = cut_problem(faces);
    const std::size_t nodes = problem.unary.size() / problem.labels;
    BenchRow result{.name = "cut",
                    .what = fmt::format("alpha-expansion, {} faces, {} labels", nodes, problem.labels),
                    .goal = "gco-v3's energy in its time or less",
                    .others = others};
    double energy = 0;
    // One thread by nature; so few milliseconds deserve more runs.
    result.cost = measure(5 * context.runs(), [&] {
        energy = alpha_expansion(problem.unary, problem.labels, problem.edges, problem.weight, problem.compatibility)
                     .energies.back();
    });
    result.single_thread = result.cost;
    const double simple = energy_of_conditional_modes(problem);
    result.remarks.push_back(fmt::format("energy {:.1f}; iterated conditional modes reach {:.1f}", energy, simple));
    result.numbers = {{"energy", energy}, {"energy_of_conditional_modes", simple}, {"edges", problem.edges.size()}};
    row(result);
}

}  // namespace

void bench_boosting(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    constexpr std::size_t k_rows = 60'000;
    QuantizedFeatures quantized;
    BoostingData data = make_boosting_data(k_rows, k_features, k_classes);
    quantized = quantize(data.features, data.weights, {});
    data.features = {};
    BenchRow result{
        .name = "boosting",
        .what = fmt::format("JointBoost, {} rounds, {} x {}, {} classes", k_stumps, k_rows, k_features, k_classes),
        .goal = "a fifth of XGBoost's CPU time: 38 s CPU",
        .others = "XGBoost hist stumps 189 s CPU; the authors' program 11.8 s a round on 24,640 x 803, 6 classes"};
    BoostOptions options;
    options.rounds = k_stumps;
    double loss = 0;
    const auto run = [&] {
        loss = train_jointboost({quantized, data.labels, data.weights, {}}, k_classes, options).loss.back();
    };
    result.cost = measure(context.runs(), run);
    result.remarks.push_back(fmt::format("training loss {:.4f}; quantization not included", loss));
    if (!context.quick()) result.single_thread = measure_single_thread(1, run);
    row(result);
}

void bench_scoring(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    constexpr std::size_t k_rows = 20'000, k_calls = 20;
    const BoostingData data = make_boosting_data(k_rows, k_features, k_classes);
    const BoostedStumps classifier = random_stumps(k_stumps, k_features, k_classes);
    std::vector<float> expected(k_rows * k_classes), actual(expected.size());
    CpuStumpScorer plain;
    Device device({.name = context.device_name()});
    Profiler profiler;
    GpuStumpScorer scorer(device, &profiler);
    const auto score = [&](StumpScorer& by, std::vector<float>& out) {
        for (std::size_t i = 0; i < k_calls; ++i) by.probabilities(classifier, data.features, Link::softmax, 1.0F, out);
    };
    score(plain, expected);
    score(scorer, actual);  // compiles the kernel
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (!(std::abs(actual[i] - expected[i]) <= 1e-5F))
            throw DeviceError(fmt::format("{} scores stumps wrongly: value {} is {} instead of {}", device.info().name,
                                          i, actual[i], expected[i]));

    BenchRow result{.name = "scoring",
                    .what = fmt::format("{} stumps, {} x {}, {} classes", k_stumps, k_rows, k_features, k_classes),
                    .goal = "at most 2x the CPU time of vectorized C++: 110 ms",
                    .others = "plain C++ 55 ms, XGBoost 128 ms"};
    profiler.reset();
    result.cost = per_call(measure(context.runs(), [&] { score(scorer, actual); }), k_calls);
    double milliseconds = 0;
    for (const auto& [kernel, entry] : profiler.entries()) milliseconds += entry.milliseconds;
    const double device_seconds = 1e-3 * milliseconds / static_cast<double>(k_calls * context.runs());
    result.single_thread = per_call(measure_single_thread(context.runs(), [&] { score(plain, expected); }), k_calls);
    const double ratio = result.cost.cpu / result.single_thread->cpu;
    result.remarks.push_back(fmt::format("on {}: {:.1f} times the CPU time of plain C++", device.info().name, ratio));
    result.numbers["cpu_over_plain"] = ratio;
    if (device_seconds > 0) add_shares(classifier, k_rows, device_seconds, measure_ceilings(device), result);
    row(result);
}

void bench_cut(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    bench_cut_of(20'000, "gco-v3 22 ms, CGAL 631 ms, each on an energy of its own", context, row);
    bench_cut_of(100'000, "gco-v3 158 ms, CGAL 3987 ms, each on an energy of its own", context, row);
}

}  // namespace exemplar
