#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/placement/streamlines.h"

namespace exemplar::test_support {

inline float length_of(const HatchStroke& stroke) {
    float length = 0;
    for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
        length += (stroke.points[i + 1] - stroke.points[i]).norm();
    return length;
}

inline std::size_t pixel_of(const HatchingFields& fields, const Vec2& at) {
    return fields.index(static_cast<int>(std::floor(at.x())), static_cast<int>(std::floor(at.y())));
}

/// Pixels of a layer that are farther from all of its strokes than a share of the spacing.
inline double empty_share(const std::vector<HatchStroke>& strokes, const HatchingFields& fields, std::size_t layer,
                          float share) {
    std::vector<float> nearest(fields.size(), std::numeric_limits<float>::max());
    for (const HatchStroke& stroke : strokes) {
        if (stroke.layer != layer) continue;
        for (const Vec2& at : stroke.points) {
            const int reach = static_cast<int>(2 * fields.spacing[pixel_of(fields, at)]) + 1;
            for (int y = std::max(0, int(at.y()) - reach); y < std::min(fields.height, int(at.y()) + reach); ++y)
                for (int x = std::max(0, int(at.x()) - reach); x < std::min(fields.width, int(at.x()) + reach); ++x) {
                    const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                    float& here = nearest[fields.index(x, y)];
                    here = std::min(here, (center - at).norm());
                }
        }
    }
    std::size_t hatched = 0, empty = 0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        if (fields.level[i] <= layer) continue;
        ++hatched;
        empty += nearest[i] > share * fields.spacing[i];
    }
    return static_cast<double>(empty) / static_cast<double>(std::max<std::size_t>(hatched, 1));
}

}  // namespace exemplar::test_support
