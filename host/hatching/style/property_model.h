#pragma once

#include <cmath>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"
#include "host/learn/boosting/quantize.h"

namespace exemplar {

/// A positive stroke property as a product of functions of single features (thesis Eq. 4.8):
/// y = prod_k (a_k x_k + b_k)^alpha_k.
struct PropertyModel {
    struct Term {
        std::uint32_t feature = 0;  ///< of the expanded set, see powers.h
        float a = 0, b = 1;
        float exponent = 1;       ///< alpha
        float low = 0, high = 0;  ///< range of x seen in training: beyond it, x counts as at its end; no number as low
        float least = 0;          ///< positive: a x + b counts as no less
        bool operator==(const Term&) const = default;
    };
    std::vector<Term> terms;
    float factor = 1;  ///< of all

    /// The value of one term for the feature's value x (its power taken): log(a x + b) * alpha.
    static float log_value(const Term& term, float x);
    /// y of items whose expanded feature k is `feature(k)`.
    template <typename Feature>
    float evaluate(Feature&& feature) const {
        float sum = std::log(factor);
        for (const Term& term : terms) sum += log_value(term, feature(term.feature));
        return std::exp(sum);
    }
    bool operator==(const PropertyModel&) const = default;
};

/// Parts of a drawing, such as its quarters.
constexpr std::size_t k_property_blocks = 4;

struct PropertyTraining {
    const FeatureMatrix& features;       ///< base features of the rows
    const QuantizedFeatures& quantized;  ///< of the same
    std::span<const float> target;       ///< y, positive; one per row
    std::span<const std::uint8_t> held_out;
    std::span<const std::uint8_t> block;  ///< which part of the drawing each row is in, below k_property_blocks
    std::size_t most_terms = 24;
};

struct LearnedProperty {
    PropertyModel model;
    double error = 0;  ///< mean squared error of log y over the rows held out (over all, if none is)
};

/// Gradient-based boosting for regression in the log domain (Zemel and Pitassi 2001; thesis Sec. 2.4.3, 4.4.3,
/// Eq. 4.9): each round adds the feature whose log(a x + b), with the a and b that fit log y best under the current
/// weights, minimizes sum of w_i r^-1/2 exp(r (log y_i - log(a x_i + b))^2), with r by line search (the first: r = 1);
/// it ends where the rows held out are fitted best. Beyond the thesis, the exponents of the chosen terms, in the thesis
/// r_k / sum of r, are also fitted by least squares, and models found by forward selection compete, whose terms fit
/// what those before them leave: all terms of boosting aim at y, so that it may not come to the second factor of a
/// product. What fits the rows held out best is kept, a term more only if it is better by 2%. Features are preferred
/// whose function, fitted to the other blocks of the drawing, holds in each: many fit one shape by chance. Inverses of
/// features that are next to zero on a hundredth of the rows are left out.
LearnedProperty learn_property(
    const PropertyTraining& training, const std::function<void()>& progress = [] {});

}  // namespace exemplar
