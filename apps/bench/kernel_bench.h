#pragma once

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "gpu/runtime/device.h"
#include "gpu/runtime/profiler.h"
#include "host/core/stopwatch.h"

// The kernels of labeling and of animated surfaces on the device of EXEMPLAR_DEVICE, else the best: each is compared
// with its CPU reference once, then timed by the device's own timestamps. The argument is the number of faces, of
// animated surfaces that of vertices. Counters, per call:
//   MB       what must cross the memory at least: every input once, every output once
//   Mop      additions, comparisons and selections that the result needs, 10^6
//   GB/s, Gop/s       these by device time
//   copy, fma         and as shares of the device's measured ceilings (one multiply-add counts as two operations)
//   call, call_cpu    milliseconds of the whole call with its transfers: wall clock, and CPU of this process
//   reference_cpu     milliseconds of CPU of the reference, on one thread where it is of an animated surface
//   host_cpu          the same of the host's own implementation for devices that are CPUs
//   copying           of re-projection: device milliseconds of a kernel that only copies, and moves as many bytes
//   entries           of learned curvature: components that matter to a tile, per attribute

namespace exemplar {

constexpr float k_tolerance = 1e-5f;

struct Bench {
    Device device;
    Ceilings ceilings = measure_ceilings(device);
};

inline Bench& bench() {
    static Bench instance;
    return instance;
}

// The least work of one call.
struct Work {
    double bytes = 0.0;
    double operations = 0.0;
};

// Whether device and reference agree; if not, the benchmark reports it instead of a time.
inline bool verified(benchmark::State& state, const std::vector<float>& actual, const std::vector<float>& expected) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (std::abs(actual[i] - expected[i]) <= k_tolerance) continue;
        state.SkipWithError(fmt::format("value {} is {}, but the reference has {}", i, actual[i], expected[i]).c_str());
        return false;
    }
    return true;
}

// Times `call`, whose dispatches `profiler` sees, by the device's clock.
template <typename Call>
void time_call(benchmark::State& state, Profiler& profiler, const Work& work, Call&& call) {
    double device_ms = 0.0;
    const Stopwatch watch;
    for (auto _ : state) {
        profiler.reset();
        call();
        double milliseconds = 0.0;
        for (const auto& [kernel, entry] : profiler.entries()) milliseconds += entry.milliseconds;
        state.SetIterationTime(1e-3 * milliseconds);
        device_ms += milliseconds;
    }
    const auto calls = static_cast<double>(state.iterations());
    const double seconds = 1e-3 * device_ms / calls;
    const Ceilings& ceilings = bench().ceilings;
    state.counters["MB"] = 1e-6 * work.bytes;
    state.counters["Mop"] = 1e-6 * work.operations;
    state.counters["GB/s"] = 1e-9 * work.bytes / seconds;
    state.counters["Gop/s"] = 1e-9 * work.operations / seconds;
    state.counters["copy"] = 1e-9 * work.bytes / seconds / ceilings.copy_gb_per_s;
    state.counters["fma"] = 1e-9 * work.operations / seconds / ceilings.fma_gflop_per_s;
    state.counters["call"] = 1e3 * watch.wall() / calls;
    state.counters["call_cpu"] = 1e3 * watch.cpu() / calls;
}

// CPU milliseconds of the second of two calls: the first fills caches.
template <typename Call>
double reference_cpu(Call&& call) {
    call();
    const Stopwatch watch;
    call();
    return 1e3 * watch.cpu();
}

// The sizes that all kernels are measured at.
inline void three_sizes(benchmark::internal::Benchmark* benchmark) {
    benchmark->Arg(5'000)->Arg(20'000)->Arg(100'000)->UseManualTime()->Unit(benchmark::kMillisecond);
}

}  // namespace exemplar
