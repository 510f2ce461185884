#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/style/orientation_function.h"

namespace exemplar {

/// What was measured of strokes, at pixels on their center lines that are not where strokes cross.
struct OrientationSamples {
    std::vector<std::uint16_t> x, y;      ///< N pixels
    std::vector<DoubledAngle> direction;  ///< N: of the stroke
    std::vector<std::uint8_t> level;      ///< N: 1 or 2
    std::vector<float> spacing;           ///< N: pixels
    OrientationFields fields;             ///< of those pixels

    std::size_t size() const { return x.size(); }
};

/// For each sample the samples within a radius of its pixel, itself included: compressed rows.
struct SampleNeighbors {
    std::vector<std::uint32_t> begin, neighbor;
    std::span<const std::uint32_t> of(std::size_t i) const {
        return {neighbor.data() + begin[i], neighbor.data() + begin[i + 1]};
    }
};
/// The radius of a sample is its spacing, times `factor`.
SampleNeighbors sample_neighbors(const OrientationSamples& samples, float factor);

/// Marks items in rectangles of random place and size until `share` of each group is marked (thesis Sec. 4.4.1): for
/// each item 1 if it is held out. A group of fewer than 20 items has none.
std::vector<std::uint8_t> held_out_rectangles(std::span<const std::uint16_t> x, std::span<const std::uint16_t> y,
                                              std::span<const std::uint32_t> group, double share, std::uint64_t seed);

}  // namespace exemplar
