#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

namespace exemplar {

/// Returns the logistic function sigma(x) = 1 / (1 + exp(-x)).
template <std::floating_point T>
T logistic(T x) {
    return 1 / (1 + std::exp(-x));
}

/// Returns log sigma(x), finite also where sigma(x) underflows to 0.
template <std::floating_point T>
T log_logistic(T x) {
    return std::min(x, T{0}) - std::log1p(std::exp(-std::abs(x)));
}

/// Replaces values x, at least one, by their softmax: exp(x_i) over the sum of all exp(x_j). Does not overflow, as all
/// are relative to the largest.
template <std::floating_point T>
void softmax(std::span<T> values) {
    const T largest = *std::ranges::max_element(values);
    T sum = 0;
    for (T& value : values) sum += value = std::exp(value - largest);
    for (T& value : values) value /= sum;
}

/// Returns element `index` of the softmax of scale * values, where the others are not needed.
template <std::floating_point T>
T softmax_at(std::span<const T> values, std::size_t index, T scale) {
    const T largest = scale * *std::ranges::max_element(values);
    T sum = 0;
    for (const T value : values) sum += std::exp(scale * value - largest);
    return std::exp(scale * values[index] - largest) / sum;
}

}  // namespace exemplar
