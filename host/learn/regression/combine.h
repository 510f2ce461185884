#pragma once

#include <span>
#include <vector>

namespace exemplar {

/// Weights by which the predictions of J predictors add up to one (thesis Eqs. 5.10, 5.11), from the residual r of each
/// (its sum of squared errors): w_j = (sum over k != j of r_k) / ((J - 1) sum over all k of r_k). They sum to 1; a
/// single predictor gets 1, predictors without errors share evenly, and there are none without predictors. Throws
/// UsageError for a residual that is below 0 or not finite.
std::vector<double> predictor_weights(std::span<const double> residuals);

}  // namespace exemplar
