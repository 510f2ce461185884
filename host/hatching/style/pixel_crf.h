#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/graphcut/alpha_expansion.h"
#include "host/hatching/features/hatching_view.h"

namespace exemplar {

/// Parameters of the pairwise term (thesis Eqs. 4.3, 4.5). Segments and hatching levels have separate ones, as their
/// boundaries differ.
struct PixelCrfParameters {
    float strength = 1;  ///< l, not negative
    float offset = -1;   ///< mu
    bool operator==(const PixelCrfParameters&) const = default;
};

/// Labels the pixels of a view by alpha-expansion (thesis Sec. 4.3.1). Unary terms are -log P(c | x) (Eq. 4.2).
/// Pixels of an 8-neighborhood with different labels cost -l (log(P(e_i) + P(e_j)) + mu), at least 0 (Eqs. 4.3,
/// 4.5).
class PixelCrf {
  public:
    /// `boundary`: P(e | x) of each covered pixel.
    PixelCrf(const CoveredPixels& pixels, int width, std::span<const float> boundary);

    /// Returns the label of each covered pixel. `probabilities`: covered pixels x classes.
    std::vector<std::int32_t> solve(std::span<const float> probabilities, std::size_t classes,
                                    const PixelCrfParameters& parameters);

  private:
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<float> evidence_;  // per edge: log(P(e_i) + P(e_j))
    AlphaExpansion expansion_;
};

}  // namespace exemplar
