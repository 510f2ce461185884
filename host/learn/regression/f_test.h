#pragma once

#include <cstddef>

namespace exemplar {

struct FTest {
    double statistic = 0;  ///< F; infinite if only the larger model fits exactly
    double p_value = 1;    ///< chance of an F at least as large if the smaller model holds
};

/// Tests whether the larger of two nested least-squares models fits better than chance (the general form of thesis
/// Eq. 5.6):
/// F = ((residual_small - residual_full) / (parameters_full - parameters_small)) /
///     (residual_full / (samples - parameters_full)).
/// Residuals are sums of squared errors over the samples; below 1e-20 of `scale` (the targets' sum of squares, if
/// known) they count as 0. The p-value is 1 if the test is undefined (no degrees of freedom left, equally many
/// parameters, or both models exact), and 0 if only the larger model is exact. Throws UsageError for residuals that
/// are below 0 or not finite, or a larger model with fewer parameters.
FTest f_test(double residual_small, std::size_t parameters_small, double residual_full, std::size_t parameters_full,
             std::size_t samples, double scale = 0);

}  // namespace exemplar
