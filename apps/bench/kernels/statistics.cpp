#include "apps/bench/kernels/statistics.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "host/core/statistics.h"

namespace exemplar {

double median(std::span<const double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> reordered(values.begin(), values.end());
    return median(std::span(reordered));
}

double relative_error(std::span<const double> values) {
    const double middle = median(values);
    std::vector<double> distances;
    distances.reserve(values.size());
    for (const double value : values) distances.push_back(std::abs(value - middle));
    // A median's standard error is sqrt(pi / 2) times that of a mean.
    constexpr double k_deviation = 1.4826;
    const double of_median = std::sqrt(std::numbers::pi / 2 / static_cast<double>(values.size()));
    return middle > 0 ? k_deviation * of_median * median(distances) / middle : 0;
}

bool Ratio::is_slower(double errors, double least) const {
    return std::log(value) > std::max(errors * error, std::log1p(least));
}
bool Ratio::is_faster(double errors, double least) const {
    return -std::log(value) > std::max(errors * error, std::log1p(least));
}

Ratio ratio_of(std::span<const double> now, std::span<const double> before) {
    return {median(now) / median(before), std::hypot(relative_error(now), relative_error(before))};
}

Ratio without_drift(const Ratio& ratio, const Ratio& drift) {
    return {ratio.value / drift.value, std::hypot(ratio.error, drift.error)};
}

Ratio mean_ratio(std::span<const Ratio> ratios) {
    if (ratios.empty()) return {};
    double logarithms = 0, variance = 0;
    for (const Ratio& ratio : ratios) {
        logarithms += std::log(ratio.value);
        variance += ratio.error * ratio.error;
    }
    const auto count = static_cast<double>(ratios.size());
    return {std::exp(logarithms / count), std::sqrt(variance) / count};
}

}  // namespace exemplar
