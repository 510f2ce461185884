#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/hatching/comparison/drawing_comparison.h"

namespace exemplar {

/// A style learned from one half of a drawing, compared in the other half.
struct HalfComparison {
    std::string learned_from;  ///< "left", "right", "upper", "lower"
    DrawingComparison comparison;
};

/// Learns from each half of a drawing, as cut at the median of its strokes' places, and predicts the other. `mask`: the
/// pixels that count. Calls `progress` before each half. Throws DataError if a half has too few strokes.
std::vector<HalfComparison> compare_halves(HatchScene& scene, const ComparedDrawing& artist, const PixelMask& mask,
                                           std::uint64_t seed, const std::function<void(const char*)>& progress);

}  // namespace exemplar
