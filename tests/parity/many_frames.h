#pragma once

#include <gtest/gtest.h>

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
    const std::size_t before = resident_bytes();
    for (std::size_t frame = 0; frame < 10'000; ++frame) {
        const auto again = run(frames[frame % frames.size()]);
        for (std::size_t i = 0; i < again.size(); ++i)
            ASSERT_TRUE(same_bits(again[i], first[frame % frames.size()][i])) << "frame " << frame;
    }
    // A buffer that every frame leaves behind would be megabytes of vertices alone, or pages of descriptors.
    EXPECT_LE(resident_bytes(), before + 1'000'000);
}

}  // namespace exemplar::test_support
