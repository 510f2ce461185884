#pragma once

#include <cstdint>
#include <vector>

#include "host/learn/boosting_rows.h"
#include "host/learn/stump_search.h"

namespace exemplar {

/// The responses of one stump, per lane.
struct StumpResponse {
    float above = 0, below = 0;    ///< a, b
    std::vector<float> elsewhere;  ///< k_l of lanes that do not share the split, zero for those that do
};

/// a, b and k_l in closed form (the minimum of Eq. 3.6 for a given split), over all rows.
StumpResponse fit_response(const BoostingRows& rows, const SplitCandidate& split);

/// Keeps the training weights: scales them to a total near one, so that a separable problem, whose loss falls without
/// bound, neither underflows nor loses accuracy.
class WeightUpdate {
  public:
    /// Scales the weights of `rows` to a total of one.
    explicit WeightUpdate(BoostingRows& rows);
    /// Multiplies each weight by exp(-z h) (Eq. 3.7) and returns the loss (Eq. 3.5) over its initial value.
    double apply(BoostingRows& rows, const SplitCandidate& split, const StumpResponse& response);

  private:
    double total_ = 1.0;  ///< sum of the weights as they are stored
    int exponent_ = 0;    ///< they are stored times 2^exponent
};

}  // namespace exemplar
