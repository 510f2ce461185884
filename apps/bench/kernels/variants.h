#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apps/bench/kernels/measurement.h"

namespace exemplar {

/// The variants of a kernel that differ in one parameter.
struct VariantComparison {
    std::string operation, kernel, parameter;
    Judged judged = Judged::by_kernel;  ///< what the times are of
    std::size_t size = 0;
    std::vector<double> as_is;                                  ///< milliseconds of each repeat, as it was before
    std::map<std::uint32_t, std::vector<double>> milliseconds;  ///< by value
    std::optional<std::uint32_t> chosen;  ///< the fastest, if it beats what was before beyond noise and by a twentieth
};

/// Compares variants of the kernels of an operation, each with its reference, times them in turns, and sets those
/// chosen in the device's tuning. `known`: kernels that need not be looked at any more; those that were are added.
/// Throws DeviceError if a variant's results differ from the reference.
std::vector<VariantComparison> compare_variants(Device& device, const OperationKind& kind, std::size_t size,
                                                const KernelFilter& filter, const TimingOptions& options,
                                                std::vector<std::string>& known);

nlohmann::ordered_json to_json(const VariantComparison& comparison);

}  // namespace exemplar
