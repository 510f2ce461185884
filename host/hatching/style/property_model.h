#pragma once

#include <cmath>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/learn/boosting/quantize.h"
#include "host/learn/feature_matrix.h"

namespace exemplar {

/// A positive stroke property as a product of functions of single features (thesis Eq. 4.8):
/// y = prod_k (a_k x_k + b_k)^alpha_k.
struct PropertyModel {
    struct Term {
        std::uint32_t feature = 0;  ///< of the expanded set, see powers.h
        float a = 0, b = 1;
        float exponent = 1;       ///< alpha
        float low = 0, high = 0;  ///< x is clamped to this range, seen in training; NaN counts as low
        float least = 0;          ///< positive lower bound of a x + b
        bool operator==(const Term&) const = default;
    };
    std::vector<Term> terms;
    float factor = 1;  ///< constant factor of y

    /// Returns alpha log(a x + b) of a term; x is the feature with its power taken.
    static float log_value(const Term& term, float x);
    /// Returns y of an item whose expanded feature k is `feature(k)`.
    template <typename Feature>
    float evaluate(Feature&& feature) const {
        float sum = std::log(factor);
        for (const Term& term : terms) sum += log_value(term, feature(term.feature));
        return std::exp(sum);
    }
    bool operator==(const PropertyModel&) const = default;
};

/// Number of blocks of a drawing, such as its quarters, for cross-validation.
constexpr std::size_t k_property_blocks = 4;

struct PropertyTraining {
    const FeatureMatrix& features;       ///< base features of the rows
    const QuantizedFeatures& quantized;  ///< the same features, quantized
    std::span<const float> target;       ///< y, positive; one per row
    std::span<const std::uint8_t> held_out;
    std::span<const std::uint8_t> block;  ///< per row: its block of the drawing, below k_property_blocks
    std::size_t max_terms = 24;
};

struct LearnedProperty {
    PropertyModel model;
    double error = 0;  ///< mean squared error of log y over held-out rows, or over all if none is held out
};

/// Learns a property by gradient-based boosting of log y (Zemel and Pitassi 2001; thesis Sec. 2.4.3, 4.4.3, Eq.
/// 4.9). Each round adds the feature that minimizes the sum of w_i r^-1/2 exp(r (log y_i - log(a x_i + b))^2), where
/// a and b fit log y under the current weights and r = 1 at first, by line search later. Held-out rows decide when
/// to stop. Beyond the thesis (docs/hatching.md), exponents (there r_k / sum of r) are also fitted by least squares,
/// and models of forward selection compete. A later model replaces the best one only if it lowers the held-out error
/// by 2%. Features are ranked by cross-validation over blocks; inverses of features near zero on 1% of the rows are
/// excluded.
LearnedProperty learn_property(
    const PropertyTraining& training, const std::function<void()>& progress = [] {});

}  // namespace exemplar
