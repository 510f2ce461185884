#include "apps/bench/kernels/timing.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <string>

#include "gpu/runtime/device/errors.h"
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

void require_timestamps(const Timed& timed) {
    timed.profiler->reset();
    timed.operation->run();
    if (timed.profiler->entries().empty())
        throw DeviceError(
            "this device has no timestamps, so its kernels cannot be timed; choose another with --device");
}

}  // namespace

std::vector<OperationTimes> time_in_turns(std::span<const Timed> timed, const TimingOptions& options) {
    initialize();
    std::vector<OperationTimes> times(timed.size());
    std::map<std::string, OperationTimes*> by_name;
    for (std::size_t i = 0; i < timed.size(); ++i) {
        require_timestamps(timed[i]);
        by_name[timed[i].name] = &times[i];
        benchmark::RegisterBenchmark(timed[i].name.c_str(),
                                     [&one = timed[i]](benchmark::State& state) { time_one(state, one); })
            ->UseManualTime()
            ->MinTime(options.seconds)
            ->Repetitions(static_cast<int>(options.repeats));
    }
    Collector collector(std::move(by_name));
    benchmark::RunSpecifiedBenchmarks(&collector, "all");
    benchmark::ClearRegisteredBenchmarks();
    return times;
}

}  // namespace exemplar
