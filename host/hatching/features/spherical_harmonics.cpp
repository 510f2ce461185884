#include "host/hatching/features/spherical_harmonics.h"

#include <cmath>
#include <numbers>

namespace exemplar {

Harmonics spherical_harmonics(const Vec3& direction) {
    const float x = direction.x(), y = direction.y(), z = direction.z();
    const float xx = x * x, yy = y * y, zz = z * z;
    return {0.28209479f,
            0.48860251f * y,
            0.48860251f * z,
            0.48860251f * x,
            1.09254843f * x * y,
            1.09254843f * y * z,
            0.31539157f * (3 * zz - 1),
            1.09254843f * x * z,
            0.54627422f * (xx - yy),
            0.59004359f * y * (3 * xx - yy),
            2.89061144f * x * y * z,
            0.45704580f * y * (5 * zz - 1),
            0.37317633f * z * (5 * zz - 3),
            0.45704580f * x * (5 * zz - 1),
            1.44530572f * z * (xx - yy),
            0.59004359f * x * (xx - 3 * yy),
            2.50334294f * x * y * (xx - yy),
            1.77013077f * y * z * (3 * xx - yy),
            0.94617470f * x * y * (7 * zz - 1),
            0.66904654f * y * z * (7 * zz - 3),
            0.10578555f * (35 * zz * zz - 30 * zz + 3),
            0.66904654f * x * z * (7 * zz - 3),
            0.47308735f * (xx - yy) * (7 * zz - 1),
            1.77013077f * x * z * (xx - 3 * yy),
            0.62583574f * (xx * (xx - 3 * yy) - yy * (3 * xx - yy))};
}

Harmonics distant_light(const Vec3& direction) {
    constexpr float k_pi = std::numbers::pi_v<float>;
    // The zonal coefficients of a clamped cosine (Ramamoorthi and Hanrahan 2001): how bands of light reach a surface.
    constexpr std::array<float, k_harmonic_bands> k_cosine{k_pi, 2 * k_pi / 3, k_pi / 4, 0, -k_pi / 24};
    Harmonics light = spherical_harmonics(direction);
    float straight = 0;
    for (std::size_t l = 0, k = 0; l < k_harmonic_bands; ++l) {
        const float window = 0.5f * (1 + std::cos(k_pi * static_cast<float>(l) / static_cast<float>(k_harmonic_bands)));
        straight += window * k_cosine[l] * static_cast<float>(2 * l + 1) / (4 * k_pi);
        for (; k < (l + 1) * (l + 1); ++k) light[k] *= window;
    }
    for (float& coefficient : light) coefficient /= straight;
    return light;
}

float dot(std::span<const float, k_harmonics> first, std::span<const float, k_harmonics> second) {
    float sum = 0;
    for (std::size_t k = 0; k < k_harmonics; ++k) sum += first[k] * second[k];
    return sum;
}

std::vector<Vec3> sphere_directions(std::size_t count) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    std::vector<Vec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
        const double radius = std::sqrt(1 - z * z), angle = golden * static_cast<double>(i);
        directions.push_back(Vec3d(radius * std::cos(angle), radius * std::sin(angle), z).cast<float>());
    }
    return directions;
}

}  // namespace exemplar
