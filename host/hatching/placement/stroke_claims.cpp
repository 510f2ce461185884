#include "host/hatching/placement/stroke_claims.h"

#include <algorithm>

#include "host/hatching/placement/clearance.h"

namespace exemplar {
namespace {

constexpr int k_round_bits = 12, k_shortness_bits = 2, k_place_bits = 18;
static_assert(k_round_bits + k_shortness_bits + k_place_bits == 32);
/// Half the diagonal of a pixel, rounded up.
constexpr std::int32_t k_half_diagonal = 2897;

std::int32_t claim_reach(const PlacementGrid& grid, std::int32_t spacing) {
    return share_of_spacing(spacing, grid.rules.test_share) / 2 + k_half_diagonal;
}

/// Calls body(pixel) for the pixels of a claim.
template <typename Body>
void for_claimed_pixels(const PlacementGrid& grid, std::span<const FinePoint> way, Body&& body) {
    for (std::size_t i = 0; i < way.size(); ++i) {
        const std::int32_t spacing = grid.at(way[i])->spacing();
        if (is_recorded(i, way.size(), spacing))
            for_pixels_within(grid, way[i], claim_reach(grid, spacing),
                              [&](std::size_t pixel, std::int32_t, std::int32_t) { body(pixel); });
    }
}

}  // namespace

StrokeClaims::StrokeClaims(const PlacementGrid& grid) : grid_(grid), words_(k_hatch_layers * grid.size(), ~0U) {}

void StrokeClaims::begin_round() {
    // Claims of a later round are smaller than all earlier ones; words are reset when the round counter wraps.
    round_ = (round_ + 1) & ((1U << k_round_bits) - 1);
    if (round_ == 0) std::ranges::fill(words_, ~0U);
}

std::uint32_t StrokeClaims::claim_of(std::uint32_t place, std::uint32_t shortness) const {
    constexpr std::uint32_t k_mask = (1U << k_place_bits) - 1;
    const std::uint32_t mixed = place * 0x2c1b5U & k_mask;
    const std::uint32_t chance = (mixed ^ mixed >> (k_place_bits / 2)) * 0x297a9U & k_mask;
    const std::uint32_t rounds_left = (1U << k_round_bits) - 1 - round_;
    return (rounds_left << k_shortness_bits | shortness) << k_place_bits | chance;
}

void StrokeClaims::claim(std::uint32_t layer, std::span<const FinePoint> way, std::uint32_t claim) {
    std::uint32_t* const words = words_.data() + layer * grid_.size();
    for_claimed_pixels(grid_, way, [&](std::size_t pixel) { atomic_min(words[pixel], claim); });
}

bool StrokeClaims::wins(std::uint32_t layer, std::span<const FinePoint> way, std::uint32_t claim) const {
    const std::uint32_t* const words = words_.data() + layer * grid_.size();
    bool all = true;
    for_claimed_pixels(grid_, way, [&](std::size_t pixel) { all &= words[pixel] == claim; });
    return all;
}

}  // namespace exemplar
