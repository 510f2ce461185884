#pragma once

#include <string>
#include <vector>

#include "apps/bench/kernels/measurement.h"
#include "apps/bench/kernels/statistics.h"

namespace exemplar {

/// How a kernel's time has changed.
struct Change {
    std::string operation, kernel;
    std::size_t size = 0;
    Ratio ratio;  ///< now over before, less what the whole device has drifted
    double drift = 1;
};

/// Changes of the kernels that both have. A device may be slower today as a whole: what kernels that only copy or only
/// calculate, timed in turns with each operation, have changed by in the geometric mean is taken away.
std::vector<Change> changes_between(const std::vector<Measurement>& now, const std::vector<Measurement>& before);

}  // namespace exemplar
