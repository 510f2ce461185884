#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/graphcut/alpha_expansion.h"
#include "host/hatching/features/hatching_view.h"

namespace exemplar {

/// Parameters of the pairwise term (thesis Eqs. 4.3, 4.5). Segments and hatching levels each have their own, as they do
/// not have the same boundaries.
struct PixelCrfParameters {
    float strength = 1;  ///< l: not negative
    float offset = -1;   ///< mu
    bool operator==(const PixelCrfParameters&) const = default;
};

/// Labels the pixels of a view (thesis Sec. 4.3.1): unary terms -log P(c | x) (Eq. 4.2) and, between the pixels of
/// 8-neighborhoods, -l (log(P(e_i) + P(e_j)) + mu) where labels differ (Eqs. 4.3, 4.5; at least 0), by alpha-expansion.
class PixelCrf {
  public:
    /// `boundary`: P(e | x) of each covered pixel.
    PixelCrf(const CoveredPixels& pixels, int width, std::span<const float> boundary);

    /// The label of each covered pixel; `probabilities`: rows x classes.
    std::vector<std::int32_t> solve(std::span<const float> probabilities, std::size_t classes,
                                    const PixelCrfParameters& parameters);
    /// Eq. 4.16 as a mean: P(e) over the pixels that have a neighbor of another label; 0 without any.
    double boundary_agreement(std::span<const std::int32_t> labels) const;

  private:
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<float> boundary_, evidence_;  // of each pixel; of each edge: log(P(e_i) + P(e_j))
    AlphaExpansion expansion_;
};

}  // namespace exemplar
