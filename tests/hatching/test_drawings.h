#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <span>
#include <utility>
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

/// Which of the 64 samples of a pixel are within `half` of a line, as bits.
inline std::uint64_t covered_samples(int x, int y, const Vec2& a, const Vec2& b, float half) {
    const float distance = distance_to(Vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f), a, b);
    if (distance > half + 0.75f) return 0;
    if (distance < half - 0.75f) return ~std::uint64_t{0};
    std::uint64_t bits = 0;
    for (int k = 0; k < 64; ++k) {
        const Vec2 at(static_cast<float>(x) + (static_cast<float>(k % 8) + 0.5f) / 8,
                      static_cast<float>(y) + (static_cast<float>(k / 8) + 0.5f) / 8);
        if (distance_to(at, a, b) <= half) bits |= std::uint64_t{1} << k;
    }
    return bits;
}

/// Calls body(x, y, share) for the pixels that a stroke covers a share of, to within 1/64.
template <typename Body>
void cover(const InkStroke& stroke, int width, int height, Body body) {
    const float half = 0.5f * stroke.width;
    std::map<std::pair<int, int>, std::uint64_t> covered;
    for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
        const Vec2 &a = stroke.points[i], &b = stroke.points[i + 1];
        const Vec2 low = a.cwiseMin(b).array() - (half + 1), high = a.cwiseMax(b).array() + (half + 1);
        for (int y = std::max(0, static_cast<int>(low.y())); y <= std::min(height - 1, static_cast<int>(high.y())); ++y)
            for (int x = std::max(0, static_cast<int>(low.x())); x <= std::min(width - 1, static_cast<int>(high.x()));
                 ++x)
                if (const std::uint64_t bits = covered_samples(x, y, a, b, half)) covered[{x, y}] |= bits;
    }
    for (const auto& [at, bits] : covered) body(at.first, at.second, static_cast<float>(std::popcount(bits)) / 64);
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
