#pragma once

#include <cmath>
#include <cstddef>
#include <string>

namespace exemplar {

/// Each scalar feature x also counts as x^2, 1/x and 1/x^2 (thesis App. B.2): feature k of the expanded set is power
/// k % k_powers of feature k / k_powers.
constexpr std::size_t k_powers = 4;

/// Returns power 0 to 3 of a value: x, x^2, 1/x, 1/x^2. In inverses, magnitudes below 1e-6 count as 1e-6.
inline float power_of(float x, std::size_t power) {
    if (power == 0) return x;
    if (power == 1) return x * x;
    const float safe = std::abs(x) < 1e-6f ? (x < 0 ? -1e-6f : 1e-6f) : x;
    return power == 2 ? 1 / safe : 1 / (safe * safe);
}

/// Returns the name of a power of a feature called x: "x", "x^2", "1/x", "1/x^2".
inline std::string name_of_power(const std::string& name, std::size_t power) {
    const std::string raised = power % 2 == 1 ? name + "^2" : name;
    return power >= 2 ? "1/" + raised : raised;
}

}  // namespace exemplar
