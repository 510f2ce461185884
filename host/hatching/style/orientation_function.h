#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/orientation_fields.h"

namespace exemplar {

/// A rule for the direction of strokes: f = sum of w_k v_k over a few features (thesis Eq. 4.7).
struct OrientationFunction {
    struct Term {
        std::uint32_t feature;
        float weight;
        bool operator==(const Term&) const = default;
    };
    std::vector<Term> terms;

    /// f of item i, normalized.
    DoubledAngle evaluate(const OrientationFields& fields, std::size_t i) const;
    bool operator==(const OrientationFunction&) const = default;
};

/// Weighted sums of products of all fields with each other and with target directions: all that least squares need, and
/// sums of two sets of items are those of both.
struct FieldProducts {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(k_orientation_fields, k_orientation_fields);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(k_orientation_fields);
    double total = 0;  ///< of the weights

    FieldProducts& operator+=(const FieldProducts& other);
};
FieldProducts field_products(const OrientationFields& fields, std::span<const DoubledAngle> target,
                             std::span<const float> weight);
/// Forward selection: the fields, in the order in which each leaves the least squares, with all weights fitted anew.
std::vector<Eigen::Index> select_fields(const FieldProducts& products, std::size_t most);
/// The mean of |u - sum of w_k v_k|^2 over the items with the best weights of these fields.
double least_squares_error(const FieldProducts& products, const std::vector<Eigen::Index>& fields);

/// What learning an orientation function is told.
struct OrientationTraining {
    const OrientationFields& fields;
    std::span<const DoubledAngle> target;    ///< u_i
    std::span<const float> weight;           ///< of each item, not negative
    std::span<const std::uint8_t> held_out;  ///< 1: not trained on, but decides when to stop
    std::size_t most_terms = 6;
};

struct LearnedOrientation {
    OrientationFunction function;
    double error = 0;  ///< weighted mean of |u - f|^2 over the items held out (over all, if none is)
};

/// Gradient-based boosting for regression (Zemel and Pitassi 2001; thesis Sec. 2.4.3, 4.4.1): each round adds the
/// feature that minimizes sum of w_i r^-1/2 exp(r |u_i - v_i|^2), with r by line search (the first: r = 1), multiplies
/// the weights by that term, and ends where the items held out are fitted best; weights are the r over their sum.
/// Beyond the thesis, functions found by forward selection, whose weights are fitted by least squares, compete on the
/// items held out: averages alone cannot tell which of two good features is followed where they differ. One more
/// feature has to take 5% off the error. No weight or no feature that is defined anywhere: no terms.
LearnedOrientation learn_orientation(const OrientationTraining& training);

}  // namespace exemplar
