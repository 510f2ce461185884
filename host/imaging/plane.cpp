#include "host/imaging/plane.h"

#include <algorithm>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// The range [begin, end) of a for which both a and a + offset are in [0, count).
struct Overlap {
    std::size_t begin, end;
};

Overlap overlap(std::size_t count, std::ptrdiff_t offset) {
    const auto n = static_cast<std::ptrdiff_t>(count);
    const std::ptrdiff_t begin = std::clamp<std::ptrdiff_t>(-offset, 0, n),
                         end = std::clamp<std::ptrdiff_t>(n - offset, 0, n);
    return {static_cast<std::size_t>(begin), static_cast<std::size_t>(std::max(begin, end))};
}

std::ptrdiff_t offset_of(std::size_t weight, std::span<const double> weights) {
    return static_cast<std::ptrdiff_t>(weight) - static_cast<std::ptrdiff_t>(weights.size() / 2);
}

/// Adds a shifted and weighted row to another. Compilers turn plain loops over neighbors into vector instructions.
void add(double weight, const double* from, double* to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
}

}  // namespace

Plane weighted_sums_along_x(const Plane& in, std::span<const double> weights) {
    Plane out(in.width, in.height);
    parallel_for(in.height, [&](std::size_t y) {
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const std::ptrdiff_t offset = offset_of(k, weights);
            const Overlap x = overlap(in.width, offset);
            add(weights[k], in.row(y).data() + (static_cast<std::ptrdiff_t>(x.begin) + offset),
                out.row(y).data() + x.begin, x.end - x.begin);
        }
    });
    return out;
}

Plane weighted_sums_along_y(const Plane& in, std::span<const double> weights) {
    Plane out(in.width, in.height);
    parallel_for(in.height, [&](std::size_t y) {
        for (std::size_t k = 0; k < weights.size(); ++k) {
            const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(y) + offset_of(k, weights);
            if (from < 0 || from >= static_cast<std::ptrdiff_t>(in.height)) continue;
            add(weights[k], in.row(static_cast<std::size_t>(from)).data(), out.row(y).data(), in.width);
        }
    });
    return out;
}

}  // namespace exemplar
