#pragma once

#include <cstdint>
#include <vector>

#include "host/learn/boosting/boosting_rows.h"

namespace exemplar {

/// A split of one feature and the lanes that share it.
struct SplitCandidate {
    float gain = 0;  ///< by how much Eq. 3.6 falls below that of constants k_c alone
    std::uint32_t feature = 0;
    std::uint32_t threshold = 0;  ///< index: "above" is bin > threshold
    std::uint64_t lanes = 0;      ///< bit l: lane l shares the split; zero if no split gains anything
};

/// The responses of one stump, per lane.
struct StumpResponse {
    float above = 0, below = 0;    ///< a, b
    std::vector<float> elsewhere;  ///< k_l of lanes that do not share the split, zero for those that do

    StumpResponse scaled(float factor) const;
};

/// Computes a, b and k_l in closed form (the minimum of Eq. 3.6 for a given split), over all rows.
StumpResponse fit_response(const BoostingRows& rows, const SplitCandidate& split);

/// Factors on the weights below and above a split.
struct WeightFactors {
    LaneFactors below, above;
};

/// Updates the training weights. Scales them to a total near one, so that weights neither underflow nor lose
/// accuracy in separable problems, whose loss falls without bound.
class WeightUpdate {
  public:
    /// Scales the weights of `rows` to a total of one.
    explicit WeightUpdate(BoostingRows& rows);
    /// Multiplies each weight by exp(-z h) (Eq. 3.7) and returns the loss (Eq. 3.5) relative to its initial value.
    double apply(BoostingRows& rows, const SplitCandidate& split, const StumpResponse& response);
    /// The factors of the last update.
    const WeightFactors& factors() const { return factors_; }

  private:
    WeightFactors factors_;
    double total_ = 1.0;  ///< sum of the stored weights
    int exponent_ = 0;    ///< stored weights are scaled by 2^exponent
};

}  // namespace exemplar
