#pragma once

#include <string>
#include <vector>

#include "apps/bench/kernels/baseline.h"
#include "apps/bench/kernels/measurement.h"
#include "gpu/runtime/device/executable_statistics.h"

namespace exemplar {

// Tables of timed kernels, for `exemplar bench shaders` and `exemplar bench spirv`.

/// Prints the device's name and its ceilings.
void print_ceilings(const Device& device, const Ceilings& ceilings);

/// Prints a row per kernel, with shares of the ceilings.
void print_kernel_rows(const Measurement& measurement, const Ceilings& ceilings);

/// Returns a driver's statistics in one line.
std::string statistics_text(const std::vector<ExecutableStatistic>& statistics);

/// Prints what the driver tells of the kernels' code, if it tells anything.
void print_driver_statistics(const Device& device, const std::vector<Measurement>& measurements);

/// Prints all changes since the baseline. Throws Error, which says how many have become slower, if any has; UsageError
/// if the baseline has none of the kernels.
void compare_with_earlier(const std::vector<Measurement>& now, const std::vector<Measurement>& before);

}  // namespace exemplar
