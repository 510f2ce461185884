#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "tests/parity/tensors.h"
#include "tests/support/resident_bytes.h"

namespace exemplar::test_support {

/// Runs `frames` again and again, 10,000 in all: each must give the bits of its first run, and memory must not grow.
/// `run` returns an array of what it downloads.
template <typename Frame, typename Run>
void expect_repeatable_without_growth(const std::vector<Frame>& frames, Run&& run) {
    std::vector<decltype(run(frames[0]))> first;
    first.reserve(frames.size());
    for (const Frame& frame : frames) first.push_back(run(frame));
    for (int i = 0; i < 200; ++i) run(frames[0]);
    constexpr std::size_t k_half = 5'000;
    std::array<std::size_t, 2> growth{};
    for (std::size_t half = 0; half < growth.size(); ++half) {
        const std::size_t before = resident_bytes();
        for (std::size_t frame = half * k_half; frame < (half + 1) * k_half; ++frame) {
            const auto again = run(frames[frame % frames.size()]);
            for (std::size_t i = 0; i < again.size(); ++i)
                ASSERT_TRUE(same_bits(again[i], first[frame % frames.size()][i])) << "frame " << frame;
        }
        growth[half] = std::max(resident_bytes(), before) - before;
    }
    // A buffer that every frame leaves behind would be megabytes of vertices alone, or pages of descriptors, in both
    // halves. In one of them the heap may grow once, or the system may bring back what it had put away. The C library's
    // heaps of several threads grow by some 100 bytes a frame although no block stays: with MALLOC_ARENA_MAX=1 they do
    // not.
    EXPECT_LE(std::min(growth[0], growth[1]), 500'000u) << growth[0] << " and " << growth[1] << " bytes";
}

}  // namespace exemplar::test_support
