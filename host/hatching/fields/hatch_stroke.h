#pragma once

#include <cstddef>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A stroke of a hatching as it is drawn.
struct HatchStroke {
    std::size_t layer = 0;      ///< 0: a hatch; 1: a cross-hatch
    std::vector<Vec2> points;   ///< center line, pixels: at least two points, at most 2 pixels apart
    std::vector<float> widths;  ///< pixels, one per point
    float darkness = 1;         ///< in (0, 1]: 1 is black
    bool operator==(const HatchStroke&) const = default;
};

}  // namespace exemplar
