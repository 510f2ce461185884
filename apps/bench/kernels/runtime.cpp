// The kernels that ceilings are measured with.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "apps/bench/kernels/operation.h"
#include "embedded/runtime_atomics_comp.h"
#include "embedded/runtime_copy_comp.h"
#include "embedded/runtime_empty_comp.h"
#include "embedded/runtime_multiply_add_comp.h"
#include "embedded/runtime_shared_memory_comp.h"
#include "embedded/runtime_texels_comp.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "shaders/shared/ceilings.h"

namespace exemplar {
namespace {

using shared::CopyParameters;
using shared::MultiplyAddParameters;

struct Copying {
    Copying(Device& device, Profiler& profiler, std::size_t size)
        : vectors(static_cast<std::uint32_t>(size)),
          values(4 * size),
          source(device, 4 * size * sizeof(float)),
          target(device, source.bytes()),
          kernel(device, shaders::runtime_copy_comp, {.push_constants = layout_of<CopyParameters>()}),
          stream(device, &profiler) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 1000);
        source.upload(std::span<const float>(values));
    }
    void run() {
        stream.dispatch(kernel, vectors, {source, target}, CopyParameters{vectors});
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<float> copied(values.size());
        target.download(std::span(copied));
        return {{"copies", largest_difference(copied, values), 0}};
    }
    std::map<std::string, Work> work() const {
        return {{"runtime/copy.comp", {.bytes = 32.0 * vectors, .operations = 0}}};
    }
    std::uint32_t vectors;
    std::vector<float> values;
    Buffer source, target;
    Kernel kernel;
    Stream stream;
};

constexpr std::uint32_t k_rounds = 64;
constexpr MultiplyAddParameters k_multiply_add{.rounds = k_rounds, .factor = 0.9999f, .summand = 1e-4f};

// Returns the expected sums of the 32 chains of an item: x -> factor x + summand converges to a fixed point, so the
// value after all rounds has a closed form.
std::vector<float> multiplied(std::size_t size) {
    const auto factor = static_cast<double>(k_multiply_add.factor);
    const double fixed = static_cast<double>(k_multiply_add.summand) / (1 - factor), left = std::pow(factor, k_rounds);
    std::vector<float> results(size);
    for (std::size_t i = 0; i < size; ++i) {
        const double starts = 8 * (0.1 + 0.2 + 0.3) + 4 * 28 + 32e-6 * static_cast<double>(i);
        results[i] = static_cast<float>(left * starts + 32 * (1 - left) * fixed);
    }
    return results;
}

struct MultiplyAdd {
    MultiplyAdd(Device& device, Profiler& profiler, std::size_t size)
        : results(device, size * sizeof(float)),
          kernel(device, shaders::runtime_multiply_add_comp, {.push_constants = layout_of<MultiplyAddParameters>()}),
          stream(device, &profiler) {}
    void run() {
        stream.dispatch(kernel, results.bytes() / sizeof(float), {results}, k_multiply_add);
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<float> sums(results.bytes() / sizeof(float));
        results.download(std::span(sums));
        // Tolerance for 64 roundings of values below 10 in each of 32 chains.
        return {{"sums", largest_difference(sums, multiplied(sums.size())), 2e-3}};
    }
    std::map<std::string, Work> work() const {
        const std::size_t count = results.bytes() / sizeof(float);
        const auto items = static_cast<double>(count);
        return {{"runtime/multiply_add.comp",
                 {.bytes = 4 * items, .operations = 2 * items * k_rounds * shared::k_multiply_adds_per_round}}};
    }
    Buffer results;
    Kernel kernel;
    Stream stream;
};

// Differences of whole numbers.
Difference difference_of_counts(std::string of, std::span<const std::uint32_t> actual,
                                std::span<const std::uint32_t> expected) {
    double largest = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
        largest = std::max(largest, std::abs(static_cast<double>(actual[i]) - static_cast<double>(expected[i])));
    return {std::move(of), largest, 0};
}

struct Launching {
    Launching(Device& device, Profiler& profiler, std::size_t size)
        : threads(size), kernel(device, shaders::runtime_empty_comp), stream(device, &profiler) {}
    void run() {
        stream.dispatch(kernel, threads, {});
        stream.finish();
    }
    std::vector<Difference> differences() const { return {{"nothing", 0, 0}}; }
    std::map<std::string, Work> work() const { return {{"runtime/empty.comp", {.bytes = 0, .operations = 0}}}; }
    std::size_t threads;
    Kernel kernel;
    Stream stream;
};

constexpr shared::RoundParameters k_repeated_reads{.rounds = 16};
constexpr std::uint32_t k_reads = 16 * shared::k_reads_per_round;

// Returns the sums of the vectors (j, j + 1, j + 2, j + 3) that each item reads: j from its own one on, modulo `count`.
std::vector<std::uint32_t> sums_of_reads(std::size_t items, std::uint32_t group, std::uint32_t count) {
    std::vector<std::uint32_t> sums(items, 0);
    for (std::size_t i = 0; i < items; ++i)
        for (std::uint32_t read = 0; read < k_reads; ++read)
            sums[i] += 4 * ((static_cast<std::uint32_t>(i) % group + read) % count) + 6;
    return sums;
}

struct SharedReading {
    SharedReading(Device& device, Profiler& profiler, std::size_t size)
        : result(device, size * sizeof(std::uint32_t)),
          kernel(device, shaders::runtime_shared_memory_comp, {.push_constants = layout_of<shared::RoundParameters>()}),
          stream(device, &profiler) {}
    std::size_t items() const { return result.bytes() / sizeof(std::uint32_t); }
    void run() {
        stream.dispatch(kernel, items(), {result}, k_repeated_reads);
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<std::uint32_t> sums(items());
        result.download(std::span(sums));
        const std::uint32_t group = kernel.local_size()[0];
        return {difference_of_counts("sums", sums, sums_of_reads(sums.size(), group, shared::k_shared_vectors))};
    }
    std::map<std::string, Work> work() const {
        const auto count = static_cast<double>(items());
        return {{"runtime/shared_memory.comp", {.bytes = 4 * count, .operations = 4 * count * k_reads}}};
    }
    Buffer result;
    Kernel kernel;
    Stream stream;
};

struct TexelReading {
    TexelReading(Device& device, Profiler& profiler, std::size_t size)
        : texels(device, std::size_t{16} * shared::k_texels_read),
          result(device, size * sizeof(std::uint32_t)),
          kernel(device, shaders::runtime_texels_comp,
                 {.push_constants = layout_of<shared::RoundParameters>(),
                  .elements = {layout_of<std::array<std::uint32_t, 4>>()}}),
          stream(device, &profiler) {
        std::vector<std::uint32_t> values(std::size_t{4} * shared::k_texels_read);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint32_t>(i / 4 + i % 4);
        texels.upload(std::span<const std::uint32_t>(values));
    }
    std::size_t items() const { return result.bytes() / sizeof(std::uint32_t); }
    void run() {
        stream.dispatch(kernel, items(), {texels, result}, k_repeated_reads);
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<std::uint32_t> sums(items());
        result.download(std::span(sums));
        return {difference_of_counts("sums", sums,
                                     sums_of_reads(sums.size(), shared::k_texels_read, shared::k_texels_read))};
    }
    std::map<std::string, Work> work() const {
        const auto count = static_cast<double>(items());
        return {{"runtime/texels.comp",
                 {.bytes = 16.0 * shared::k_texels_read + 4 * count, .operations = 4 * count * k_reads}}};
    }
    Buffer texels, result;
    Kernel kernel;
    Stream stream;
};

struct AtomicCounting {
    AtomicCounting(Device& device, Profiler& profiler, std::size_t size)
        : counters(device, size * sizeof(std::uint32_t)),
          kernel(device, shaders::runtime_atomics_comp, {.push_constants = layout_of<shared::RoundParameters>()}),
          stream(device, &profiler) {}
    std::size_t items() const { return counters.bytes() / sizeof(std::uint32_t); }
    void run() {
        stream.fill(counters, 0);
        stream.dispatch(kernel, items(), {counters}, k_repeated_reads);
        stream.finish();
    }
    std::vector<Difference> differences() const {
        std::vector<std::uint32_t> counts(items());
        counters.download(std::span(counts));
        return {
            difference_of_counts("counts", counts, std::vector<std::uint32_t>(counts.size(), k_repeated_reads.rounds))};
    }
    std::map<std::string, Work> work() const {
        const auto count = static_cast<double>(items());
        return {{"runtime/atomics.comp", {.bytes = 8 * count, .operations = count * k_repeated_reads.rounds}}};
    }
    Buffer counters;
    Kernel kernel;
    Stream stream;
};

}  // namespace

std::vector<OperationKind> runtime_operations() {
    return {
        {"launching", "items", {64, 16'384}, {&shaders::runtime_empty_comp}, {}, prepare_as<Launching>},
        {"reads of shared memory",
         "items",
         {16'384, 131'072},
         {&shaders::runtime_shared_memory_comp},
         {},
         prepare_as<SharedReading>},
        {"reads of texels", "items", {16'384, 131'072}, {&shaders::runtime_texels_comp}, {}, prepare_as<TexelReading>},
        {"atomic additions",
         "counters",
         {16'384, 131'072},
         {&shaders::runtime_atomics_comp},
         {},
         prepare_as<AtomicCounting>},
        {"copying", "vec4s", {100'000, 1'000'000}, {&shaders::runtime_copy_comp}, {}, prepare_as<Copying>},
        {"multiply-adds",
         "items",
         {16'384, 131'072},
         {&shaders::runtime_multiply_add_comp},
         {},
         prepare_as<MultiplyAdd>}};
}

}  // namespace exemplar
