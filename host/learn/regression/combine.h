#pragma once

#include <span>
#include <vector>

namespace exemplar {

/// Returns the weights (thesis Eqs. 5.10, 5.11) of J predictors whose predictions are added up, from the residual r
/// of each (its sum of squared errors): w_j = (sum over k != j of r_k) / ((J - 1) sum over all k of r_k). They sum
/// to 1. A single predictor gets 1, predictors without errors share evenly, and no predictors give no weights.
/// Throws UsageError for a residual that is below 0 or not finite.
std::vector<double> predictor_weights(std::span<const double> residuals);

}  // namespace exemplar
