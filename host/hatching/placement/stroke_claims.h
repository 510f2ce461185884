#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Resolves conflicts between the strokes tried in one round. A stroke claims all pixels within half the test
/// distance, and half a pixel's diagonal, of its traced streamline, so that the claims of streamlines closer than
/// the test distance overlap. A pixel goes to the smallest claim. A stroke that holds all of its pixels wins: it
/// would be the same if the other winners had been placed before it.
class StrokeClaims {
  public:
    /// Keeps a reference to `grid`.
    explicit StrokeClaims(const PlacementGrid& grid);

    /// Begins a round: earlier claims become void.
    void begin_round();
    /// Returns the claim of the candidate at a place of the round's list, below 2^18. Longer strokes get smaller
    /// claims; ties are resolved pseudo-randomly.
    std::uint32_t claim_of(std::uint32_t place, std::uint32_t shortness) const;

    /// Claims the pixels of a streamline. Thread-safe.
    void claim(std::uint32_t layer, std::span<const FinePoint> way, std::uint32_t claim);
    /// Returns whether a claim holds all pixels of its streamline. Call it after all claims of the round.
    bool wins(std::uint32_t layer, std::span<const FinePoint> way, std::uint32_t claim) const;

  private:
    const PlacementGrid& grid_;
    std::vector<std::uint32_t> words_;  // layer by layer
    std::uint32_t round_ = 0;
};

}  // namespace exemplar
