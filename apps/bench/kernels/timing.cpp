#include "apps/bench/kernels/timing.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "gpu/runtime/vulkan/errors.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"

namespace exemplar {
namespace {

// Counter of a benchmark for the whole run; the other counters are kernels.
constexpr std::string_view k_run = "run";

// Some settings of Google Benchmark can be set only by a command line, once.
void initialize() {
    static const bool done = [] {
        std::array arguments{std::string("exemplar"), std::string("--benchmark_enable_random_interleaving=true")};
        std::array<char*, 2> pointers{arguments[0].data(), arguments[1].data()};
        int count = static_cast<int>(pointers.size());
        benchmark::Initialize(&count, pointers.data());
        return true;
    }();
    static_cast<void>(done);
}

// Collects the reported runs, without those that only determine the iterations of a repeat.
class Collector final : public benchmark::BenchmarkReporter {
  public:
    explicit Collector(std::map<std::string, OperationTimes*> times) : times_(std::move(times)) {}
    bool ReportContext(const Context&) override { return true; }  // NOLINT: named by Google Benchmark
    void ReportRuns(const std::vector<Run>& runs) override {      // NOLINT
        for (const Run& run : runs) {
            if (run.run_type != Run::RT_Iteration) continue;
            OperationTimes& times = *times_.at(run.run_name.function_name);
            for (const auto& [name, milliseconds] : run.counters)
                (name == k_run ? times.runs : times.kernels[name]).push_back(milliseconds.value);
        }
    }

  private:
    std::map<std::string, OperationTimes*> times_;
};

void time_one(benchmark::State& state, const Timed& timed) {
    std::map<std::string, double> sums;
    for (auto _ : state) {
        check_interrupt();
        timed.profiler->reset();
        const Stopwatch watch;
        timed.operation->run();
        sums[std::string(k_run)] += 1e3 * watch.wall();
        double all = 0;
        for (const auto& [kernel, entry] : timed.profiler->entries()) {
            sums[kernel] += entry.milliseconds;
            all += entry.milliseconds;
        }
        state.SetIterationTime(1e-3 * all);
    }
    for (const auto& [name, sum] : sums) state.counters[name] = sum / static_cast<double>(state.iterations());
}

// Seconds of one run.
struct RunSeconds {
    double device = 0, wall = 0;
};

// Throws if the device has no timestamps.
RunSeconds time_run(const Timed& timed) {
    timed.profiler->reset();
    const Stopwatch watch;
    timed.operation->run();
    RunSeconds seconds{.device = 0, .wall = watch.wall()};
    if (timed.profiler->entries().empty())
        throw DeviceError(
            "this device has no timestamps, so its kernels cannot be timed; choose another with --device");
    for (const auto& [kernel, entry] : timed.profiler->entries()) seconds.device += 1e-3 * entry.milliseconds;
    return seconds;
}

// Returns the repeats that the wall time allows if each is a single run.
std::size_t possible_repeats(std::span<const RunSeconds> runs, const TimingOptions& options) {
    constexpr std::size_t k_min_repeats = 3;
    double all = 0;
    for (const RunSeconds& run : runs) all += run.wall;
    const double possible = options.wall_seconds / std::max(all, 1e-9);
    if (possible >= static_cast<double>(options.repeats)) return options.repeats;
    return std::min(options.repeats, std::max(k_min_repeats, static_cast<std::size_t>(possible)));
}

// Returns the device time of a repeat, so that all repeats of `count` operations end in the wall time.
double repeat_seconds(const RunSeconds& run, std::size_t count, std::size_t repeats, const TimingOptions& options) {
    constexpr double k_least = 1e-6;
    const double wall = options.wall_seconds / static_cast<double>(count * repeats);
    const double share_of_device = run.wall > 0 ? std::min(run.device / run.wall, 1.0) : 1.0;
    return std::max(k_least, std::min(options.seconds, wall * share_of_device));
}

}  // namespace

std::vector<OperationTimes> time_in_turns(std::span<const Timed> timed, const TimingOptions& options) {
    initialize();
    std::vector<OperationTimes> times(timed.size());
    std::map<std::string, OperationTimes*> by_name;
    std::vector<RunSeconds> runs;
    runs.reserve(timed.size());
    for (const Timed& one : timed) runs.push_back(time_run(one));
    const std::size_t repeats = possible_repeats(runs, options);
    for (std::size_t i = 0; i < timed.size(); ++i) {
        by_name[timed[i].name] = &times[i];
        benchmark::RegisterBenchmark(timed[i].name.c_str(),
                                     [&one = timed[i]](benchmark::State& state) { time_one(state, one); })
            ->UseManualTime()
            ->MinTime(repeat_seconds(runs[i], timed.size(), repeats, options))
            ->Repetitions(static_cast<int>(repeats));
    }
    Collector collector(std::move(by_name));
    benchmark::RunSpecifiedBenchmarks(&collector, "all");
    benchmark::ClearRegisteredBenchmarks();
    return times;
}

}  // namespace exemplar
