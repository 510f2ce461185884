#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/core/random.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar::test_support {

/// Hatching that is the same all over a picture.
inline HatchingFields even_fields(int width, int height, float orientation, float spacing = 6, float length = 60) {
    HatchingFields fields(width, height);
    std::ranges::fill(fields.level, k_single_hatching);
    std::ranges::fill(fields.orientation[0], orientation);
    std::ranges::fill(fields.orientation[1], orientation < 1.8f ? orientation + 1.2f : orientation - 1.2f);
    std::ranges::fill(fields.thickness, 1.5f);
    std::ranges::fill(fields.intensity, 1.0f);
    std::ranges::fill(fields.spacing, spacing);
    std::ranges::fill(fields.length, length);
    return fields;
}

/// Calls body(index, x, y) for all pixels, with their centers.
template <typename Body>
void for_pixels(const HatchingFields& fields, Body&& body) {
    for (int y = 0; y < fields.height; ++y)
        for (int x = 0; x < fields.width; ++x)
            body(fields.index(x, y), static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
}

/// An angle as orientations are given, in [0, pi).
inline float as_orientation(float angle) {
    constexpr float k_pi = std::numbers::pi_v<float>;
    const float turned = angle - k_pi * std::floor(angle / k_pi);
    return turned < k_pi ? turned : 0;
}

/// Circles around the picture's middle.
inline HatchingFields circle_fields(int width, int height, float length = 60) {
    HatchingFields fields = even_fields(width, height, 0, 6, length);
    const float x0 = 0.5f * static_cast<float>(width), y0 = 0.5f * static_cast<float>(height);
    for_pixels(fields, [&](std::size_t i, float x, float y) {
        fields.orientation[0][i] = as_orientation(std::atan2(y - y0, x - x0) + std::numbers::pi_v<float> / 2);
    });
    return fields;
}

/// Smooth waves of both layers, with an empty disc, and all targets different everywhere; the waves, and how strong
/// they are, follow a seed. `noise`: by how much single pixels differ, up to 1.
inline HatchingFields wavy_fields(int width, int height, std::uint64_t seed, float noise = 0) {
    Random random(seed);
    const auto uniform = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
    HatchingFields fields = even_fields(width, height, 0);
    const float wave = uniform(40, 120), turn = uniform(0.3, 1), start = uniform(0, 3), crossing = uniform(0.6, 1.5);
    const float x0 = uniform(0, width), y0 = uniform(0, height), hole = uniform(5, 30);
    const float spacing = uniform(3, 6), length = uniform(15, 60);
    for_pixels(fields, [&](std::size_t i, float x, float y) {
        const float along = std::sin(x / wave + start), down = std::cos(y / wave - start);
        const float speckle = noise > 0 ? noise * uniform(-0.5, 0.5) : 0;
        fields.orientation[0][i] = as_orientation(turn * (along + down) + start + speckle);
        fields.orientation[1][i] = as_orientation(fields.orientation[0][i] + crossing);
        fields.spacing[i] = spacing * (1.3f + 0.3f * down + 0.3f * speckle);
        fields.length[i] = length * (1 + 0.3f * along);
        fields.thickness[i] = 1 + 0.3f * down;
        fields.intensity[i] = 0.8f + 0.2f * along;
        fields.level[i] = std::hypot(x - x0, y - y0) < hole ? k_no_hatching
                          : along + down > 0.3f             ? k_cross_hatching
                                                            : k_single_hatching;
    });
    return fields;
}

}  // namespace exemplar::test_support
