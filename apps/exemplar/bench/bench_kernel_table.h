#pragma once

#include <string>
#include <vector>

#include "apps/bench/kernels/baseline.h"
#include "apps/bench/kernels/measurement.h"

namespace exemplar {

// Tables of timed kernels, for `exemplar bench shaders` and `exemplar bench spirv`.

/// Prints a row per kernel, with shares of the ceilings.
void print_kernel_rows(const Measurement& measurement, const Ceilings& ceilings);

/// Prints what the driver tells of the kernels' code, if it tells anything.
void print_driver_statistics(const Device& device, const std::vector<Measurement>& measurements);

/// Prints all changes since the baseline. Throws Error, which says how many have become slower, if any has; UsageError
/// if the baseline has none of the kernels.
void compare_with_earlier(const std::vector<Measurement>& now, const std::vector<Measurement>& before);

}  // namespace exemplar
