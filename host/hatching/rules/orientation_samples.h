#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/rules/orientation_function.h"

namespace exemplar {

/// Measurements of strokes at pixels of their center lines, except where strokes cross.
struct OrientationSamples {
    std::vector<std::uint16_t> x, y;      ///< N: pixel coordinates
    std::vector<DoubledAngle> direction;  ///< N: direction of the stroke
    std::vector<std::uint8_t> level;      ///< N: hatching level, 1 or 2
    std::vector<float> spacing;           ///< N: pixels
    OrientationFields fields;             ///< orientation features at these pixels

    std::size_t size() const { return x.size(); }
};

/// The neighbors of each sample within a radius, itself included, as compressed rows.
struct SampleNeighbors {
    std::vector<std::uint32_t> begin, neighbor;
    std::span<const std::uint32_t> of(std::size_t i) const {
        return {neighbor.data() + begin[i], neighbor.data() + begin[i + 1]};
    }
};
/// Finds the neighbors of all samples. The radius of a sample is its spacing times `factor`.
SampleNeighbors sample_neighbors(const OrientationSamples& samples, float factor);

/// Returns 1 for each held-out item: rectangles of random position and size are marked until they cover `share` of
/// each group (thesis Sec. 4.4.1). Groups of fewer than 20 items have no held-out items, nor groups that the
/// rectangles cover entirely. `sides`: the least and the largest side of a rectangle in pixels; zero: a twentieth and
/// a fifth of the group's extent.
std::vector<std::uint8_t> held_out_rectangles(std::span<const std::uint16_t> x, std::span<const std::uint16_t> y,
                                              std::span<const std::uint32_t> group, double share, std::uint64_t seed,
                                              std::array<double, 2> sides = {0, 0});

}  // namespace exemplar
