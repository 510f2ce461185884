#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "host/core/random.h"
#include "host/hatching/tracing/drawing_filters.h"
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
        const int row = k / 8, column = k % 8;
        const Vec2 at(static_cast<float>(x) + (static_cast<float>(column) + 0.5f) / 8,
                      static_cast<float>(y) + (static_cast<float>(row) + 0.5f) / 8);
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

/// What a scanner does to a drawing.
struct ScanOptions {
    float blur = 0;    ///< standard deviation, pixels
    float noise = 0;   ///< standard deviation, of gray
    float paper = 1;   ///< gray
    float uneven = 0;  ///< by how much paper darkens from one corner to the other
    std::uint64_t seed = 1;
};

inline Image scanned(const FloatImage& darkness, const ScanOptions& options = {}) {
    const FloatImage soft = gaussian_blur(darkness, options.blur);
    Image scan(darkness.width, darkness.height, 1);
    Random random(options.seed);
    for (int y = 0; y < scan.height; ++y)
        for (int x = 0; x < scan.width; ++x) {
            const float u = static_cast<float>(x) / static_cast<float>(scan.width);
            const float v = static_cast<float>(y) / static_cast<float>(scan.height);
            const float paper = options.paper - options.uneven * (0.6f * u * u + 0.4f * v);
            const float gray = paper * (1 - soft.pixel(x, y)[0]) + options.noise * static_cast<float>(random.normal());
            scan.pixel(x, y)[0] = static_cast<std::uint8_t>(std::clamp(std::lround(255 * gray), 0L, 255L));
        }
    return scan;
}

/// A share of values that are in order, 0.5 for the median.
inline float quantile(std::vector<float> values, double share) {
    if (values.empty()) return std::numeric_limits<float>::quiet_NaN();
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

inline Vec2 direction(float angle) {
    return {std::cos(angle), std::sin(angle)};
}

/// Parallel strokes.
struct Family {
    float angle = 0, spacing = 8, width = 2, tone = 1, length = 200;
    int strokes = 25;  ///< odd: one goes through the center

    float half_across() const { return 0.5f * spacing * static_cast<float>(strokes); }
    bool hatches(const Vec2& from_center) const {
        const Vec2 along = direction(angle), across(-along.y(), along.x());
        return std::abs(along.dot(from_center)) <= 0.5f * length && std::abs(across.dot(from_center)) <= half_across();
    }
};

inline void add_family(const Family& family, const Vec2& center, std::vector<InkStroke>& strokes) {
    const Vec2 along = direction(family.angle), across(-along.y(), along.x());
    for (int k = 0; k < family.strokes; ++k) {
        const Vec2 middle =
            center + (static_cast<float>(k) - 0.5f * static_cast<float>(family.strokes - 1)) * family.spacing * across;
        const Vec2 half = 0.5f * family.length * along;
        strokes.push_back({{middle - half, middle + half}, family.width, family.tone});
    }
}

}  // namespace exemplar::test
