#include <algorithm>
#include <optional>

#include "host/core/parallel.h"
#include "host/hatching/measurement/stroke_properties.h"

namespace exemplar {
namespace {

/// Returns how far the center line continues beyond the stroke's front or back point; negative if it ends before
/// that point.
float beyond_end(const FloatImage& darkness, const TracedStroke& stroke, bool back) {
    const TracedPoint& end = back ? stroke.points.back() : stroke.points.front();
    const std::optional<float> tip =
        end.at_crossing ? std::nullopt : distance_to_tip(darkness, stroke, back, end.thickness);
    return tip ? *tip - 0.5f * end.thickness : 0;
}

}  // namespace

void measure_lengths(const FloatImage& darkness, std::span<TracedStroke> strokes) {
    parallel_for(
        strokes.size(),
        [&](std::size_t s) {
            TracedStroke& stroke = strokes[s];
            float length = length_along(stroke);
            if (!stroke.closed) length += beyond_end(darkness, stroke, false) + beyond_end(darkness, stroke, true);
            for (TracedPoint& point : stroke.points) point.length = std::max(length, 1.0f);
        },
        16);
}

}  // namespace exemplar
