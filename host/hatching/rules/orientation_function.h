#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/orientation_fields.h"

namespace exemplar {

/// Orientation function: the direction of strokes as f = sum of w_k v_k over a few orientation features (thesis Eq.
/// 4.7).
struct OrientationFunction {
    struct Term {
        std::uint32_t feature;
        float weight;
        bool operator==(const Term&) const = default;
    };
    std::vector<Term> terms;

    /// Returns f of item i, normalized.
    DoubledAngle evaluate(const OrientationFields& fields, std::size_t i) const;
    bool operator==(const OrientationFunction&) const = default;
};

/// Normal equations of least squares over all fields: weighted sums of products of the fields with each other and
/// with the target directions. They are additive over sets of items.
struct FieldProducts {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(k_orientation_fields, k_orientation_fields);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(k_orientation_fields);
    double total = 0;  ///< sum of the weights

    FieldProducts& operator+=(const FieldProducts& other);
};
FieldProducts field_products(const OrientationFields& fields, std::span<const DoubledAngle> target,
                             std::span<const float> weight);
/// Selects at most `most` fields by forward selection, in the order of selection. Each step adds the field that
/// gives the lowest least-squares error with all weights refitted.
std::vector<Eigen::Index> select_fields(const FieldProducts& products, std::size_t most);
/// Returns the mean of |u - sum of w_k v_k|^2 over the items for the optimal weights of these fields.
double least_squares_error(const FieldProducts& products, const std::vector<Eigen::Index>& fields);

/// Input of learn_orientation().
struct OrientationTraining {
    const OrientationFields& fields;
    std::span<const DoubledAngle> target;    ///< u_i
    std::span<const float> weight;           ///< per item, not negative
    std::span<const std::uint8_t> held_out;  ///< per item, 1: only for validation, to decide when to stop
    std::size_t max_terms = 6;
};

struct LearnedOrientation {
    OrientationFunction function;
    double error = 0;  ///< weighted mean of |u - f|^2 over held-out items, or over all if none is held out
};

/// Learns an orientation function by gradient-based boosting (Zemel and Pitassi 2001; thesis Sec. 2.4.3, 4.4.1).
/// Each round adds the feature that minimizes the sum of w_i r^-1/2 exp(r |u_i - v_i|^2), with r = 1 at first and by
/// line search later, and multiplies the w_i by the exponential. Rounds stop at the best fit of the held-out items;
/// term weights are r over the sum of r. Beyond the thesis, functions found by forward selection and least squares
/// compete on the held-out items. A function with more features must lower the error by 5%. Returns no terms if all
/// weights are zero or no feature is defined anywhere.
LearnedOrientation learn_orientation(const OrientationTraining& training);

}  // namespace exemplar
