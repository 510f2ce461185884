#pragma once

#include <cstddef>
#include <span>

namespace exemplar {

/// An error rate measured after training on so many shapes.
struct LearningPoint {
    std::size_t shapes = 1;  ///< at least 1
    double error = 0;        ///< share of the surface that is labeled wrong, in [0, 1]
};

/// error(n) = limit + factor * n^-exponent: how errors fall with the number of training examples (Cortes et al. 1993).
struct PowerLaw {
    double limit = 0, factor = 0, exponent = 1;
    double error(double shapes) const;
};

/// Fits the law to the points by least squares, with limit and factor >= 0 and the exponent in [0.1, 2]. Throws
/// UsageError with fewer than three different numbers of shapes.
PowerLaw fit_power_law(std::span<const LearningPoint> points);

}  // namespace exemplar
