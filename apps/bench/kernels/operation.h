#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/kernels/shader.h"
#include "gpu/runtime/device/tuning.h"

namespace exemplar {

/// The least that one run of a kernel must do: what it must bring across the memory, every input once and every output
/// once, and the arithmetic that the result needs (additions, products, comparisons, selections; a function such as exp
/// counts as one).
struct Work {
    double bytes = 0;
    double operations = 0;
};

/// How far the device's results are from the reference's.
struct Difference {
    std::string of;  ///< "probabilities"
    double largest = 0;
    double tolerance = 0;
    bool fits() const { return largest <= tolerance; }
};

/// Kernels that do one thing together, prepared on a device.
struct Operation {
    std::function<void()> run;                             ///< once, and waits; a Profiler sees its kernels
    std::function<std::vector<Difference>()> differences;  ///< of the last run from the CPU reference
    std::function<std::map<std::string, Work>()> work;     ///< of each kernel in one run, after a run
};

/// An operation of any size.
struct OperationKind {
    std::string_view name;               ///< "stump scoring"
    std::string_view items;              ///< what its size counts: "faces"
    std::vector<std::size_t> sizes;      ///< rising; what is measured unless asked for otherwise
    std::vector<const Shader*> kernels;  ///< the profiler calls them by their names
    std::vector<TunableParameter> parameters;
    std::function<Operation(Device&, Profiler&, std::size_t size)> prepare;
};

/// All operations; every compute shader is part of at least one.
const std::vector<OperationKind>& operation_kinds();

// Those of one subject, a file each.
std::vector<OperationKind> runtime_operations();
std::vector<OperationKind> learn_operations();
std::vector<OperationKind> labeling_operations();
std::vector<OperationKind> imaging_operations();
std::vector<OperationKind> curvature_operations();
std::vector<OperationKind> learned_curvature_operations();
std::vector<OperationKind> line_operations();
std::vector<OperationKind> hatching_operations();

/// An operation from a class with run(), differences() and work(), made from a device, a profiler and a size.
template <typename State>
Operation prepare_as(Device& device, Profiler& profiler, std::size_t size) {
    const auto state = std::make_shared<State>(device, profiler, size);
    return {.run = [state] { state->run(); },
            .differences = [state] { return state->differences(); },
            .work = [state] { return state->work(); }};
}

/// The largest difference between values of the same place. NaN counts as infinity.
double largest_difference(std::span<const float> actual, std::span<const float> expected);

}  // namespace exemplar
