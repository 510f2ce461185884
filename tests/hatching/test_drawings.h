#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/imaging/image.h"
#include "host/mesh/mesh.h"

/// Drawings of strokes whose properties are known.
namespace exemplar::test {

constexpr float k_pi = std::numbers::pi_v<float>;

/// A stroke with round ends along a polyline.
struct InkStroke {
    std::vector<Vec2> points;
    float width = 2, tone = 1;
};

inline float distance_to(const Vec2& p, const Vec2& a, const Vec2& b) {
    const Vec2 way = b - a;
    const float squared = way.squaredNorm();
    const float t = squared > 0 ? std::clamp(way.dot(p - a) / squared, 0.0f, 1.0f) : 0;
    return (p - a - t * way).norm();
}

/// The share of each pixel near a stroke that it covers, to within 1/64: body(x, y, share).
template <typename Body>
void cover(const InkStroke& stroke, int width, int height, Body body) {
    constexpr int k_samples = 8;
    const float half = 0.5f * stroke.width;
    BasicImage<std::uint64_t> covered(width, height, 1);
    std::vector<std::array<int, 2>> touched;
    for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
        const Vec2 &a = stroke.points[i], &b = stroke.points[i + 1];
        const auto low = [&](int c) { return std::max(0, static_cast<int>(std::min(a[c], b[c]) - half - 1)); };
        for (int y = low(1); y <= std::min<int>(height - 1, static_cast<int>(std::max(a[1], b[1]) + half + 1)); ++y)
            for (int x = low(0); x <= std::min<int>(width - 1, static_cast<int>(std::max(a[0], b[0]) + half + 1));
                 ++x) {
                const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                const float distance = distance_to(center, a, b);
                if (distance > half + 0.75f) continue;
                std::uint64_t bits = ~std::uint64_t{0};
                if (distance > half - 0.75f)
                    for (int k = 0; k < k_samples * k_samples; ++k) {
                        const Vec2 at(static_cast<float>(x) + (static_cast<float>(k % k_samples) + 0.5f) / k_samples,
                                      static_cast<float>(y) + (static_cast<float>(k / k_samples) + 0.5f) / k_samples);
                        if (distance_to(at, a, b) > half) bits &= ~(std::uint64_t{1} << k);
                    }
                if (!covered.pixel(x, y)[0] && bits) touched.push_back({x, y});
                covered.pixel(x, y)[0] |= bits;
            }
    }
    for (const auto& [x, y] : touched)
        body(x, y, static_cast<float>(__builtin_popcountll(covered.pixel(x, y)[0])) / 64);
}

/// Darkness of a drawing: strokes over strokes, each as a filter of its tone.
inline FloatImage ink_drawing(std::span<const InkStroke> strokes, int width, int height) {
    FloatImage light(width, height, 1, 1.0f);
    for (const InkStroke& stroke : strokes)
        cover(stroke, width, height,
              [&](int x, int y, float share) { light.pixel(x, y)[0] *= 1 - share * stroke.tone; });
    for (float& value : light.data) value = 1 - value;
    return light;
}

}  // namespace exemplar::test
