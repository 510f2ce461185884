#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host/hatching/style/property_model.h"

namespace exemplar {

/// A factor (a x + b)^alpha of a property model, and how badly it fits.
struct FactorCandidate {
    double error = std::numeric_limits<double>::infinity();
    PropertyModel::Term term;
};

/// Finds factors whose logarithms fit a target, over all powers of all features. Fits on quantized features, whose
/// bins are represented by their medians.
class FactorSearch {
  public:
    /// Keeps a reference to `training`.
    explicit FactorSearch(const PropertyTraining& training);

    /// Sets the target, a logarithm per row. A quarter of its smallest exponential bounds factors from below.
    void set_target(std::vector<double> log_target);
    /// Returns at most `count` factors: of those that fit best under the weights of the rows, the ones with the
    /// lowest cross-validation error over blocks, as many features fit one shape by chance. The exponent of each is
    /// the best one of `exponents`.
    std::vector<FactorCandidate> candidates(std::span<const double> weights, std::span<const double> exponents,
                                            std::size_t count) const;
    /// Returns log(a x + b) of each row.
    std::vector<float> log_values(PropertyModel::Term term) const;

  private:
    struct BinSums;
    struct Line {
        double a, b, error;
    };
    FactorCandidate fit(std::uint32_t feature, std::span<const BinSums> sums, std::span<const double> exponents) const;
    Line fit_line(std::span<const double> x, std::span<const BinSums> sums, double low, double high) const;
    double error_of_blocks(const PropertyModel::Term& term, std::span<const double> weights) const;
    std::vector<BinSums> sums_by_block(std::size_t feature, double exponent, std::span<const double> weights) const;

    const PropertyTraining& training_;
    std::vector<double> target_;
    float least_ = 0;                         // lower bound of factors
    std::vector<std::vector<float>> middle_;  // per base feature and bin: median
    std::vector<std::uint8_t> inverses_;      // per base feature: 1 if 1/x and 1/x^2 are used
};

}  // namespace exemplar
