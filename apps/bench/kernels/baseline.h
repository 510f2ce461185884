#pragma once

#include <string>
#include <vector>

#include "apps/bench/kernels/measurement.h"
#include "apps/bench/kernels/statistics.h"

namespace exemplar {

/// Change of a kernel's time.
struct Change {
    std::string operation, kernel;
    std::size_t size = 0;
    Ratio ratio;  ///< now over before, divided by the drift of the whole device
    double drift = 1;
};

/// Returns the changes of the kernels in both measurements. As a whole device may be slower today, divides by its
/// drift: the geometric mean change of kernels that only copy or only calculate, timed in turns with each operation.
std::vector<Change> changes_between(const std::vector<Measurement>& now, const std::vector<Measurement>& before);

}  // namespace exemplar
