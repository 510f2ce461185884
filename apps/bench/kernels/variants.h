#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/kernels/measurement.h"
#include "gpu/runtime/device/executable_statistics.h"

namespace exemplar {

/// The variants of a kernel that differ in one parameter.
struct VariantComparison {
    std::string operation, kernel, parameter;
    TuningMetric judged = TuningMetric::kernel_time;  ///< which times these are
    std::size_t size = 0;
    std::vector<double> as_is;                                  ///< milliseconds per repeat, with the current value
    std::map<std::uint32_t, std::vector<double>> milliseconds;  ///< by value
    std::map<std::uint32_t, std::vector<ExecutableStatistic>> statistics;  ///< of the driver, by value
    std::optional<std::uint32_t> chosen;  ///< the fastest, if it beats the current one beyond noise and by 1/20
};

/// Compares each variant of an operation's kernels with the reference, times all in turns, and stores the chosen
/// ones in the device's tuning. Skips kernels in `known`, and adds those it has compared. Throws DeviceError if a
/// variant's results differ from the reference.
std::vector<VariantComparison> compare_variants(Device& device, const OperationKind& kind, std::size_t size,
                                                const KernelFilter& filter, const TimingOptions& options,
                                                std::vector<std::string>& known);

nlohmann::ordered_json to_json(const VariantComparison& comparison);

}  // namespace exemplar
