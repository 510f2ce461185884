#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace exemplar {

/// Returns the edges of `count` distance ranges over [0, maximum], logarithmic in 1 + 9 d / maximum. Edge b is
/// maximum * (10^(b / count) - 1) / 9, so that each range is 10^(1 / count) times as wide as the one before. The
/// thesis asks for logarithmic ranges that start at 0 (App. A.1f, i), where the plain logarithm has no value.
template <std::size_t count>
std::array<float, count + 1> log_bin_edges(float maximum) {
    std::array<float, count + 1> edges{};
    for (std::size_t b = 0; b <= count; ++b) {
        const double exponent = static_cast<double>(b) / static_cast<double>(count);
        edges[b] = static_cast<float>(static_cast<double>(maximum) * (std::pow(10.0, exponent) - 1.0) / 9.0);
    }
    return edges;
}

}  // namespace exemplar
