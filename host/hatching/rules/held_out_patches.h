#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/rules/hatching_examples.h"

namespace exemplar {

/// Returns 1 for rows that are held out: a quarter of those of each view, in rectangles with sides of three to ten
/// median spacings. That is about as far as a hand goes on as it began, so these rows tell how well
/// the gaps between what was learned from are filled.
std::vector<std::uint8_t> held_out_patches(const HatchingExamples& views, std::span<const std::uint32_t> rows,
                                           std::uint64_t seed);

}  // namespace exemplar
