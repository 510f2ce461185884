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
#include "gpu/runtime/device/tuning.h"
#include "gpu/runtime/kernels/shader.h"
#include "gpu/runtime/record/profiler.h"

namespace exemplar {

/// Minimum work of one run of a kernel: memory traffic, with every input read once and every output written once,
/// and the arithmetic of the result (additions, products, comparisons, selections; a function such as exp counts as
/// one).
struct Work {
    double bytes = 0;
    double operations = 0;
};

/// Difference of the device's results from the reference.
struct Difference {
    std::string of;  ///< "probabilities"
    double largest = 0;
    double tolerance = 0;
    bool fits() const { return largest <= tolerance; }
};

/// An operation of one or more kernels, prepared on a device.
struct Operation {
    std::function<void()> run;                             ///< runs once and waits; reports to a Profiler
    std::function<std::vector<Difference>()> differences;  ///< of the last run from the CPU reference
    std::function<std::map<std::string, Work>()> work;     ///< of each kernel in one run; call after a run
};

/// An operation that can be prepared at any size.
struct OperationKind {
    std::string_view name;               ///< "stump scoring"
    std::string_view items;              ///< what its size counts: "faces"
    std::vector<std::size_t> sizes;      ///< ascending; measured by default
    std::vector<const Shader*> kernels;  ///< by the names that the profiler uses
    std::vector<TunableParameter> parameters;
    std::function<Operation(Device&, Profiler&, std::size_t size)> prepare;
};

/// All operations; every compute shader is part of at least one.
const std::vector<OperationKind>& operation_kinds();

// Operations of one subject, one file each.
std::vector<OperationKind> runtime_operations();
std::vector<OperationKind> learn_operations();
std::vector<OperationKind> labeling_operations();
std::vector<OperationKind> imaging_operations();
std::vector<OperationKind> curvature_operations();
std::vector<OperationKind> learned_curvature_operations();
std::vector<OperationKind> line_operations();
std::vector<OperationKind> hatching_operations();

/// Makes an operation of a class with run(), differences() and work(), constructed from a device, a profiler and a
/// size.
template <typename State>
Operation prepare_as(Device& device, Profiler& profiler, std::size_t size) {
    const auto state = std::make_shared<State>(device, profiler, size);
    return {.run = [state] { state->run(); },
            .differences = [state] { return state->differences(); },
            .work = [state] { return state->work(); }};
}

/// Returns the largest difference between corresponding values. NaN counts as infinity.
double largest_difference(std::span<const float> actual, std::span<const float> expected);

}  // namespace exemplar
