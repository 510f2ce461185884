#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Which of the strokes that are tried at once may be placed. Each claims the pixels within half of the test distance
/// of the way that it has looked at, and some more, so that two claims overlap if the ways are nearer to each other
/// than that; a pixel goes to the least claim. A stroke that has all of its pixels wins: it would be the same if others
/// that win had been placed before it.
class StrokeClaims {
  public:
    /// `grid` must live as long as this.
    explicit StrokeClaims(const PlacementGrid& grid);

    /// Begins a round: what was claimed before counts no longer.
    void begin_round();
    /// The claim of the candidate at a place of the round's list, below 2^18: the shorter ones come last, else chance
    /// decides.
    std::uint32_t claim_of(std::uint32_t place, std::uint32_t shortness) const;

    /// May be called from many threads at once.
    void claim(std::uint32_t layer, std::span<const FinePoint> way, std::uint32_t claim);
    /// When all have claimed: whether all of the way's pixels are its own.
    bool wins(std::uint32_t layer, std::span<const FinePoint> way, std::uint32_t claim) const;

  private:
    const PlacementGrid& grid_;
    std::vector<std::uint32_t> words_;  // layer by layer
    std::uint32_t round_ = 0;
};

}  // namespace exemplar
