#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/hatching/stroke_properties.h"

namespace exemplar {
namespace {

constexpr float k_step = 0.25f;          ///< pixels between samples along the way out
constexpr std::size_t k_end_points = 4;  ///< points that show a stroke's darkness and direction at its end

float darkness_at(const FloatImage& image, const Vec2& at) {
    const float x = std::clamp(at.x() - 0.5f, 0.0f, static_cast<float>(image.width - 1));
    const float y = std::clamp(at.y() - 0.5f, 0.0f, static_cast<float>(image.height - 1));
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const int right = std::min(left + 1, image.width - 1), bottom = std::min(top + 1, image.height - 1);
    const float sx = x - static_cast<float>(left), sy = y - static_cast<float>(top);
    return std::lerp(std::lerp(image.pixel(left, top)[0], image.pixel(right, top)[0], sx),
                     std::lerp(image.pixel(left, bottom)[0], image.pixel(right, bottom)[0], sx), sy);
}

/// How much longer the stroke is than its points say, at its front or back; negative if they go too far.
float beyond_end(const FloatImage& darkness, const TracedStroke& stroke, bool back) {
    const std::size_t last = stroke.points.size() - 1, inward = std::min(k_end_points, last);
    const auto at = [&](std::size_t i) -> const TracedPoint& { return stroke.points[back ? last - i : i]; };
    if (at(0).at_crossing) return 0;
    Vec2 out(std::cos(at(inward).orientation), std::sin(at(inward).orientation));
    if (out.dot(at(0).center - at(inward).center) < 0) out = -out;
    float dark = 0;
    for (std::size_t i = 1; i <= inward; ++i) dark = std::max(dark, darkness_at(darkness, at(i).center));
    const float most = 2 * at(0).thickness + 3;
    for (float way = -0.5f * at(0).thickness; way < most; way += k_step)
        if (darkness_at(darkness, at(0).center + way * out) < 0.5f * dark)
            return way - 0.5f * k_step - 0.5f * at(inward).thickness;
    return 0;
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
