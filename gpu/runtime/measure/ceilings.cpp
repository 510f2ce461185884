#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <string>

#include "embedded/runtime_atomics_comp.h"
#include "embedded/runtime_copy_comp.h"
#include "embedded/runtime_empty_comp.h"
#include "embedded/runtime_multiply_add_comp.h"
#include "embedded/runtime_shared_memory_comp.h"
#include "embedded/runtime_texels_comp.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/device_info.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/core/stopwatch.h"
#include "shaders/shared/ceilings.h"

namespace exemplar {
namespace {

constexpr int k_runs = 5;
constexpr double k_min_seconds = 0.02;  // of a run, so that submitting and waiting do not matter
constexpr std::uint32_t k_max_dispatches = 512;

// Returns the seconds of the fastest of several runs of `count` commands in one submission.
template <typename Record>
double fastest_run(Stream& stream, std::uint32_t count, Record&& record) {
    double best = 0.0;
    for (int run = 0; run < k_runs; ++run) {
        for (std::uint32_t i = 0; i < count; ++i) record();
        const Stopwatch watch;
        stream.finish();
        if (run == 0 || watch.wall() < best) best = watch.wall();
    }
    return best;
}

// Returns the seconds of a command, at its fastest. By the host's clock, which is right on every device, and for copies
// too, which have no timestamps: so many commands share a submission that it takes long beside submitting.
template <typename Record>
double fastest(Stream& stream, Record&& record) {
    record();  // compiles, and fills caches
    stream.finish();
    record();
    const Stopwatch watch;
    stream.finish();
    const double count = k_min_seconds / std::max(watch.wall(), 1e-9) + 1;
    const auto commands = static_cast<std::uint32_t>(std::min(count, double{k_max_dispatches}));
    return fastest_run(stream, commands, record) / commands;
}

double copy_rate(Device& device, Stream& stream) {
    // Both buffers together exceed the caches of GPUs and of most CPUs, but not the 128 MiB of some servers.
    const std::size_t wanted = std::size_t{device.info().type == DeviceType::cpu ? 64u : 512u} << 20;
    const std::size_t bytes = buffer_limit(device.info(), wanted) / 16 * 16;
    const Buffer source(device, bytes), target(device, bytes);
    const Kernel kernel(device, shaders::runtime_copy_comp, {.push_constants = layout_of<shared::CopyParameters>()});
    stream.fill(source, 0x3f800000u);
    stream.finish();
    const shared::CopyParameters parameters{static_cast<std::uint32_t>(bytes / 16)};
    const double by_kernel = fastest(stream, [&] {
        stream.dispatch(kernel, parameters.count, {source, target}, parameters);
    });
    // D12 in docs/portability.md.
    const double by_command = fastest(stream, [&] { stream.copy(source, 0, target, 0, bytes); });
    return 2.0 * static_cast<double>(bytes) / std::min(by_kernel, by_command) * 1e-9;
}

std::uint64_t busy_threads(const Device& device) {
    return device.info().type == DeviceType::cpu ? 1u << 14 : 1u << 20;
}

// Returns rounds per second of a kernel whose parameters have rounds: enough of them that starting it does not matter.
template <typename Parameters>
double rounds_per_second(Device& device, Stream& stream, const Kernel& kernel,
                         std::initializer_list<BufferRange> buffers, Parameters parameters) {
    const std::uint64_t threads = busy_threads(device);
    const auto seconds = [&] {
        return fastest(stream, [&] { stream.dispatch(kernel, threads, buffers, parameters); });
    };
    constexpr double k_min_dispatch_seconds = 2e-3;
    double taken = seconds();
    while (taken < k_min_dispatch_seconds && parameters.rounds < (1u << 20)) {
        parameters.rounds *= 4;
        taken = seconds();
    }
    return static_cast<double>(threads) * parameters.rounds / taken;
}

double multiply_add_rate(Device& device, Stream& stream) {
    const Buffer result(device, busy_threads(device) * sizeof(float));
    const Kernel kernel(device, shaders::runtime_multiply_add_comp,
                        {.push_constants = layout_of<shared::MultiplyAddParameters>()});
    const shared::MultiplyAddParameters parameters{.rounds = 256, .factor = 0.9999f, .summand = 1e-4f};
    return 2e-9 * shared::k_multiply_adds_per_round * rounds_per_second(device, stream, kernel, {result}, parameters);
}

constexpr double k_gigabytes_per_round = 16e-9 * shared::k_reads_per_round;

double shared_memory_rate(Device& device, Stream& stream) {
    const Buffer result(device, busy_threads(device) * sizeof(std::uint32_t));
    const Kernel kernel(device, shaders::runtime_shared_memory_comp,
                        {.push_constants = layout_of<shared::RoundParameters>()});
    return k_gigabytes_per_round *
           rounds_per_second(device, stream, kernel, {result}, shared::RoundParameters{.rounds = 32});
}

double texel_rate(Device& device, Stream& stream) {
    const Buffer texels(device, 16 * shared::k_texels_read),
        result(device, busy_threads(device) * sizeof(std::uint32_t));
    stream.fill(texels, 1);
    const Kernel kernel(device, shaders::runtime_texels_comp,
                        {.push_constants = layout_of<shared::RoundParameters>(),
                         .elements = {layout_of<std::array<std::uint32_t, 4>>()}});
    return k_gigabytes_per_round *
           rounds_per_second(device, stream, kernel, {texels, result}, shared::RoundParameters{.rounds = 32});
}

double atomic_rate(Device& device, Stream& stream) {
    const Buffer counters(device, std::size_t{1} << 22);
    stream.fill(counters, 0);
    const Kernel kernel(device, shaders::runtime_atomics_comp,
                        {.push_constants = layout_of<shared::RoundParameters>()});
    return 1e-9 * rounds_per_second(device, stream, kernel, {counters}, shared::RoundParameters{.rounds = 16});
}

// Returns the microseconds of an empty dispatch between two timestamps: what each timed dispatch has in addition.
double launch_microseconds(Device& device) {
    constexpr std::uint32_t k_dispatches = 64;
    Profiler profiler;
    Stream stream(device, &profiler);
    const Kernel kernel(device, shaders::runtime_empty_comp);
    double best = 0;
    for (int run = 0; run <= k_runs; ++run) {
        profiler.reset();
        for (std::uint32_t i = 0; i < k_dispatches; ++i) stream.dispatch(kernel, 1, {});
        stream.finish();
        const double mean = 1e3 * profiler.milliseconds(std::string(kernel.name())) / k_dispatches;
        if (run == 1 || (run > 1 && mean < best)) best = mean;
    }
    return best;
}

}  // namespace

Ceilings measure_ceilings(Device& device) {
    Stream stream(device);
    return {.copy_gb_per_s = copy_rate(device, stream),
            .fma_gflop_per_s = multiply_add_rate(device, stream),
            .shared_gb_per_s = shared_memory_rate(device, stream),
            .texel_gb_per_s = texel_rate(device, stream),
            .atomic_gop_per_s = atomic_rate(device, stream),
            .launch_us = launch_microseconds(device)};
}

}  // namespace exemplar
