#include "apps/bench/spirv/user_measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/bench/kernels/references.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr double k_min_sample_milliseconds = 1;
constexpr std::size_t k_max_dispatches = 512;  // of one submission

BlockScalars words_of(std::uint32_t binding) {
    BlockScalars words;
    words.binding = binding;
    words.complete = false;
    return words;
}

BufferComparison compare_binding(const Bytes& actual, const Bytes& expected, const UserInterface& interface,
                                 std::uint32_t binding, double tolerance) {
    const BlockScalars* block = interface.block(binding);
    return compare_buffers(actual, expected, block ? *block : words_of(binding), tolerance);
}

// Returns how often a kernel is dispatched so that it takes a millisecond.
std::size_t dispatches_of(UserKernel& kernel) {
    kernel.profiler().reset();
    kernel.run(1);
    double milliseconds = 0;
    for (const auto& [name, entry] : kernel.profiler().entries()) milliseconds += entry.milliseconds;
    if (milliseconds <= 0) return k_max_dispatches;
    const double count = std::ceil(k_min_sample_milliseconds / milliseconds);
    return static_cast<std::size_t>(std::clamp(count, 1.0, static_cast<double>(k_max_dispatches)));
}

// A kernel that is dispatched `count` times per run.
struct Repeated {
    std::size_t count;
    Operation operation;
};

std::vector<Repeated> repeated_kernels(const std::vector<std::pair<std::string, UserKernel*>>& kernels) {
    std::vector<Repeated> result;
    result.reserve(kernels.size());
    for (const auto& [name, kernel] : kernels) {
        const std::size_t count = dispatches_of(*kernel);
        result.push_back({count, {.run = [one = kernel, count] { one->run(count); }, .differences = {}, .work = {}}});
    }
    return result;
}

}  // namespace

std::vector<CheckedBinding> compare_outputs(const UserKernel& kernel, const UserKernel& other,
                                            const UserInterface& interface, const std::string& with, double tolerance) {
    std::vector<CheckedBinding> checks;
    for (const ReflectedBinding& binding : interface.reflection.bindings) {
        if (!binding.writes) continue;
        checks.push_back({binding.binding, binding.name, with,
                          compare_binding(kernel.contents(binding.binding), other.contents(binding.binding), interface,
                                          binding.binding, tolerance)});
    }
    return checks;
}

CheckedBinding compare_with_file(const UserKernel& kernel, const UserInterface& interface, std::uint32_t binding,
                                 const std::filesystem::path& path, double tolerance) {
    const Bytes actual = kernel.contents(binding), expected = read_values(path);
    if (actual.size() != expected.size())
        throw UsageError(
            fmt::format("--expect {}={}: the file has {} bytes, the buffer {}; give a file of the same size", binding,
                        path.string(), expected.size(), actual.size()));
    return {binding, interface.binding(binding)->name, path.string(),
            compare_binding(actual, expected, interface, binding, tolerance)};
}

Measurement time_kernels(Device& device, const std::vector<std::pair<std::string, UserKernel*>>& kernels,
                         const Work& work, const TimingOptions& options, const Ceilings& ceilings) {
    const References references(device, ceilings);
    std::vector<Repeated> repeated = repeated_kernels(kernels);
    std::vector<Timed> timed;
    timed.reserve(kernels.size() + 2);
    for (std::size_t i = 0; i < kernels.size(); ++i)
        timed.push_back({kernels[i].first, &repeated[i].operation, &kernels[i].second->profiler()});
    references.append(timed);
    const std::vector<OperationTimes> times = time_in_turns(timed, options);
    Measurement measurement;
    measurement.operation = "spirv";
    measurement.items = "threads";
    for (std::size_t i = 0; i < kernels.size(); ++i) {
        KernelRow row{.kernel = kernels[i].first, .milliseconds = times[i].kernels.begin()->second, .work = work};
        for (double& milliseconds : row.milliseconds) milliseconds /= static_cast<double>(repeated[i].count);
        measurement.kernels.push_back(std::move(row));
    }
    measurement.references = references.times(std::span(times).subspan(kernels.size()));
    return measurement;
}

}  // namespace exemplar
