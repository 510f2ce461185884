#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace exemplar {

/// Returns the value at index `place` of the sorted values, place < values.size(); reorders the values.
template <typename T>
T order_statistic(std::span<T> values, std::size_t place) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

/// Returns the middle one of the sorted values, or the upper of the two middle ones; zero if there are none.
/// Reorders the values.
template <typename T>
T upper_median(std::vector<T>& values) {
    return values.empty() ? T{} : order_statistic(std::span<T>(values), values.size() / 2);
}

/// Returns the middle one of the sorted values, or the mean of the two middle ones; zero if there are none. Reorders
/// the values.
template <typename T>
T median(std::span<T> values) {
    if (values.empty()) return T{};
    const T upper = order_statistic(values, values.size() / 2);
    if (values.size() % 2 == 1) return upper;
    return T(0.5) * (upper + *std::max_element(values.begin(), values.begin() + values.size() / 2));
}

/// Returns the value at `share` (in [0, 1]) of the sorted values, rounded down to an index; zero if there are none.
/// Reorders the values.
template <typename T>
T quantile(std::vector<T>& values, double share) {
    if (values.empty()) return T{};
    return order_statistic(std::span<T>(values),
                           static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

/// Returns at most `count` of the items, evenly spaced in their order, the first one included.
template <typename T>
std::vector<T> evenly_spaced(const std::vector<T>& items, std::size_t count) {
    count = std::min(count, items.size());
    std::vector<T> chosen;
    chosen.reserve(count);
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(items[i * items.size() / count]);
    return chosen;
}

}  // namespace exemplar
