#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"

namespace exemplar {

/// A linear classifier of standardized features: L(x, c) = constant_c + sum over f of weight_fc z_f, where z_f is
/// (x_f - mean_f) * inverse_f, clamped to [-k_max_deviations, k_max_deviations]. A NaN feature counts as its mean.
struct LinearClassifier {
    static constexpr float k_max_deviations = 2;  ///< bound of |z_f|, so that outliers do not decide

    std::uint32_t class_count = 0;  ///< 0: there is no classifier
    std::vector<float> mean;        ///< per feature
    std::vector<float> inverse;     ///< per feature: one over the standard deviation; 0 leaves it out
    std::vector<float> weight;      ///< features x classes
    std::vector<float> constant;    ///< per class

    std::size_t feature_count() const { return mean.size(); }
};

/// Computes L of every row: rows x classes, item-major, on all cores; the result does not depend on their number.
/// Throws ModelError if `features` has fewer columns than the classifier, UsageError if `out` has another size.
void linear_scores(const LinearClassifier& classifier, const FeatureMatrix& features, std::span<float> out);
/// The same for some rows, in the order of `rows`.
void linear_scores(const LinearClassifier& classifier, const FeatureMatrix& features,
                   std::span<const std::uint32_t> rows, std::span<float> out);

/// Training data of a linear classifier.
struct LinearRows {
    const FeatureMatrix& features;
    std::span<const std::uint32_t> rows;  ///< the rows of `features` to train on
    std::span<const std::int32_t> label;  ///< per row of `features`: 0 .. classes - 1
    std::span<const float> weight;        ///< likewise: >= 0
    std::span<const std::uint8_t> fold;   ///< likewise: 0 .. fold_count - 1
    std::size_t classes, fold_count;
};

/// Ridge regression (thesis Eq. 2.19) as a discriminant function (Sec. 2.3.1): the target is 1 if a row has the
/// label, otherwise 0. Fits all rows, or all except those of one fold. Reads the rows once: their sums of products
/// per fold serve any ridge.
class LinearTraining {
  public:
    /// Takes weighted means and deviations over all rows; leaves out features that do not vary. Throws UsageError
    /// for sizes that differ, or if no row has a weight.
    explicit LinearTraining(const LinearRows& data);

    static constexpr std::size_t k_no_fold = static_cast<std::size_t>(-1);
    /// Minimizes the sum over rows of weight * (target - L)^2 + ridge * (sum of weights) * ||weight_c||^2, per class c;
    /// ridge > 0. The constant is not penalized.
    LinearClassifier solve(double ridge, std::size_t without_fold = k_no_fold) const;

  private:
    Eigen::MatrixXd products_of(const LinearRows& data, std::span<const std::uint32_t> rows, double total) const;
    Eigen::MatrixXd products(std::size_t without_fold) const;

    std::size_t classes_;
    LinearClassifier standard_;             // means and deviations alone
    std::vector<std::uint32_t> used_;       // features that vary
    std::vector<Eigen::MatrixXd> of_fold_;  // products of [z of used features, 1, targets]
};

/// Returns the classifier whose L is the mean of those of `classifiers`: at least one, all with the same features,
/// means and deviations.
LinearClassifier mean_linear(std::span<const LinearClassifier> classifiers);

}  // namespace exemplar
