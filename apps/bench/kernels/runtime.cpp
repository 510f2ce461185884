// The kernels that ceilings are measured with.

#include <cmath>

#include "apps/bench/kernels/operation.h"
#include "embedded/runtime_copy_comp.h"
#include "embedded/runtime_multiply_add_comp.h"
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

}  // namespace

std::vector<OperationKind> runtime_operations() {
    return {{"copying", "vec4s", {100'000, 1'000'000}, {&shaders::runtime_copy_comp}, {}, prepare_as<Copying>},
            {"multiply-adds",
             "items",
             {16'384, 131'072},
             {&shaders::runtime_multiply_add_comp},
             {},
             prepare_as<MultiplyAdd>}};
}

}  // namespace exemplar
