#include <algorithm>
#include <cstdint>

#include "embedded/runtime_copy_comp.h"
#include "embedded/runtime_multiply_add_comp.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/device/device_info.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/core/stopwatch.h"
#include "shaders/shared/ceilings.h"

namespace exemplar {
namespace {

constexpr int k_runs = 5;

// Returns the seconds of the fastest of several runs, after one that compiles and fills caches. The host's clock is
// accurate enough, as these dispatches take much longer than submitting, and it is right on every device.
template <typename Record>
double fastest(Stream& stream, Record&& record) {
    double best = 0.0;
    for (int run = 0; run <= k_runs; ++run) {
        record();
        const Stopwatch watch;
        stream.finish();
        if (run == 1 || (run > 1 && watch.wall() < best)) best = watch.wall();
    }
    return best;
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

double multiply_add_seconds(Stream& stream, const Kernel& kernel, const Buffer& result, std::uint32_t rounds) {
    const shared::MultiplyAddParameters parameters{.rounds = rounds, .factor = 0.9999f, .summand = 1e-4f};
    return fastest(stream, [&] { stream.dispatch(kernel, result.bytes() / sizeof(float), {result}, parameters); });
}

double multiply_add_rate(Device& device, Stream& stream) {
    const std::size_t threads = device.info().type == DeviceType::cpu ? 1u << 14 : 1u << 20;
    const Buffer result(device, threads * sizeof(float));
    const Kernel kernel(device, shaders::runtime_multiply_add_comp,
                        {.push_constants = layout_of<shared::MultiplyAddParameters>()});
    // Enough rounds that a run takes about 20 ms.
    std::uint32_t rounds = 256;
    double seconds = multiply_add_seconds(stream, kernel, result, rounds);
    for (; seconds < 0.01 && rounds < (1u << 20); seconds = multiply_add_seconds(stream, kernel, result, rounds))
        rounds *= 4;
    return 2.0 * static_cast<double>(threads) * rounds * shared::k_multiply_adds_per_round / seconds * 1e-9;
}

}  // namespace

Ceilings measure_ceilings(Device& device) {
    Stream stream(device);
    return {.copy_gb_per_s = copy_rate(device, stream), .fma_gflop_per_s = multiply_add_rate(device, stream)};
}

}  // namespace exemplar
