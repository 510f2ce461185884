#include "apps/bench/kernels/baseline.h"

#include <algorithm>

namespace exemplar {
namespace {

Ratio drift_between(const Measurement& now, const Measurement& before) {
    std::vector<Ratio> ratios;
    for (const auto& [kernel, milliseconds] : now.references)
        if (const auto then = before.references.find(kernel); then != before.references.end())
            ratios.push_back(ratio_of(milliseconds, then->second));
    return mean_ratio(ratios);
}

}  // namespace

std::vector<Change> changes_between(const std::vector<Measurement>& now, const std::vector<Measurement>& before) {
    std::vector<Change> changes;
    for (const Measurement& measurement : now) {
        const auto then = std::ranges::find_if(before, [&](const Measurement& other) {
            return other.operation == measurement.operation && other.size == measurement.size;
        });
        if (then == before.end()) continue;
        const Ratio drift = drift_between(measurement, *then);
        for (const KernelRow& row : measurement.kernels) {
            const auto old = std::ranges::find(then->kernels, row.kernel, &KernelRow::kernel);
            if (old == then->kernels.end()) continue;
            changes.push_back({measurement.operation, row.kernel, measurement.size,
                               without_drift(ratio_of(row.milliseconds, old->milliseconds), drift), drift.value});
        }
    }
    return changes;
}

}  // namespace exemplar
