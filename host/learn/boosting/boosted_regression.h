#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace exemplar {

/// Gradient-based boosting for regression (Zemel and Pitassi 2001; thesis Sec. 2.4.3, Eqs. 2.70-2.73): weak learners
/// phi_m that all approximate the target t itself, and their coefficients r_m. Minimizes
/// sum_i prod_m r_m^-1/2 exp(sum_m r_m (t_i - phi_m(x_i))^2) round by round. In each round, the caller fits weak
/// learners under weights(), compares them by line_search(), and adds the one with the lowest objective by add().
/// The caller keeps the weak learners, as this class sees only their squared errors.
class RegressionBoosting {
  public:
    /// Parameters of a line search, which replaces squared errors by the centers of equal bins.
    struct LineSearch {
        double max_error;  ///< upper end of the bins; larger squared errors count as this
        double max_r;      ///< r is searched from 0.05 to this
        std::size_t bins;
    };
    /// A coefficient of a weak learner and the objective that it leads to (Eq. 2.72).
    struct Step {
        double objective = std::numeric_limits<double>::infinity();
        double r = 1;
    };

    /// `weights`: confidence in each item, not negative; items of weight 0 are not learned from.
    explicit RegressionBoosting(std::vector<double> weights) : weights_(std::move(weights)) { normalize(); }

    /// Weights of the items in the current round. Their sum is 1, or 0 if there is nothing to learn from.
    std::span<const double> weights() const { return weights_; }

    /// Returns the r that minimizes sum_i w_i r^-1/2 exp(r e_i) for a weak learner with squared error
    /// e_i = `squared_error(i)`. In the first round, r is 1.
    template <typename SquaredError>
    Step line_search(const SquaredError& squared_error, const LineSearch& limits) const {
        std::vector<double> histogram(limits.bins);
        const double bins_per_unit = static_cast<double>(limits.bins) / limits.max_error;
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            if (!(weights_[i] > 0)) continue;
            const auto bin = static_cast<std::size_t>(static_cast<double>(squared_error(i)) * bins_per_unit);
            histogram[std::min(bin, limits.bins - 1)] += weights_[i];
        }
        return best_step(histogram, bins_per_unit, limits.max_r);
    }

    /// Adds a weak learner: multiplies the weights by exp(r_m e_i) = exp(`exponent(i)`) and normalizes them (Eq. 2.73).
    template <typename Exponent>
    void add(const Exponent& exponent) {
        for (std::size_t i = 0; i < weights_.size(); ++i) {
            if (weights_[i] > 0) weights_[i] *= std::exp(exponent(i));
        }
        normalize();
        is_first_round_ = false;
    }

  private:
    void normalize();
    Step best_step(std::span<const double> histogram, double bins_per_unit, double max_r) const;

    std::vector<double> weights_;
    bool is_first_round_ = true;
};

/// Divides the coefficients r_m of the terms by their sum, so that Eq. 2.70 is a weighted mean of weak learners.
template <typename Term>
void normalize_coefficients(std::vector<Term>& terms, float Term::*coefficient) {
    float sum = 0;
    for (const Term& term : terms) sum += term.*coefficient;
    for (Term& term : terms) term.*coefficient /= sum;
}

/// Weighted mean of squared errors over the held-out items, or over all items if none is held out. Decides when
/// boosting stops.
class HeldOutError {
  public:
    void add(bool held_out, double weight, double squared_error) {
        Sums& sums = held_out ? held_out_ : learned_;
        sums.errors += weight * squared_error;
        sums.weights += weight;
    }
    /// Returns the mean, or `otherwise` if no item has weight.
    double mean(double otherwise) const {
        const Sums& sums = held_out_.weights > 0 ? held_out_ : learned_;
        return sums.weights > 0 ? sums.errors / sums.weights : otherwise;
    }

  private:
    struct Sums {
        double errors = 0, weights = 0;
    };
    Sums held_out_, learned_;
};

}  // namespace exemplar
