#pragma once

#include <span>

#include "host/learn/softmax.h"

namespace exemplar {

/// A probability as a function of one value: P = sigma(slope x + offset).
struct LogisticCurve {
    double slope = 0, offset = 0;

    double probability(double x) const { return logistic(slope * x + offset); }
};

/// Logistic regression on one value, with a slope that is not negative. Minimizes the sum over i of
/// weight_i * -(target_i log P(x_i) + (1 - target_i) log(1 - P(x_i))). Targets are probabilities; 0 < target < 1 keeps
/// the slope finite where x separates the targets (Platt 1999). All spans have the same size, and weights a positive
/// sum.
LogisticCurve fit_rising_logistic(std::span<const double> x, std::span<const double> target,
                                  std::span<const double> weight);

}  // namespace exemplar
