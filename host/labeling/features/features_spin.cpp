#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/labeling/features/feature_families.h"

namespace exemplar {
namespace {

constexpr std::size_t k_side = 10;            ///< bins along each coordinate (thesis App. A.1g)
constexpr float k_bin_size = 0.3F;            ///< normalized units
constexpr std::size_t k_padded = k_side + 2;  ///< with a margin for points outside

using SpinImage = std::array<float, k_padded * k_padded>;

/// Adds a point bilinearly (Johnson & Hebert 1999) at radius `alpha` from the normal's line and height `beta` along it.
inline void splat(SpinImage& image, float alpha, float beta, float weight) {
    // Continuous bin positions, shifted by the margin; far points end in the margin.
    const float last = static_cast<float>(k_padded) - 1.001F;
    const float i = std::clamp(alpha / k_bin_size + 0.5F, 0.0F, last);
    const float j = std::clamp(beta / k_bin_size + 0.5F * static_cast<float>(k_side) + 0.5F, 0.0F, last);
    const std::size_t i0 = static_cast<std::size_t>(i), j0 = static_cast<std::size_t>(j);
    const float u = i - static_cast<float>(i0), v = j - static_cast<float>(j0);
    float* corner = image.data() + i0 * k_padded + j0;
    corner[0] += weight * (1.0F - u) * (1.0F - v);
    corner[1] += weight * (1.0F - u) * v;
    corner[k_padded] += weight * u * (1.0F - v);
    corner[k_padded + 1] += weight * u * v;
}

}  // namespace

/// alpha covers [0, 3], beta [-1.5, 1.5]. A sample's weight is its area share times the cosine between the normals, or
/// 0 if the cosine is negative: a soft form of the support angle, so that rounding does not add or remove walls at
/// right angles.
FeatureMatrix spin_features(const PreparedMesh& prepared) {
    FeatureMatrix matrix;
    matrix.rows = prepared.face_count();
    for (std::size_t i = 0; i < k_side; ++i) {
        for (std::size_t j = 0; j < k_side; ++j) matrix.add(fmt::format("spin.a{}b{}", i, j));
    }
    const auto measure = [&](std::size_t f) {
        SpinImage image{};
        const Vec3 &center = prepared.center[f], &normal = prepared.normal[f];
        for (std::size_t s = 0; s < prepared.sample_count(); ++s) {
            const std::uint32_t face = prepared.samples.face[s];
            const float agreement = normal.dot(prepared.normal[face]);
            if (agreement <= 0.0F) continue;
            const Vec3 offset = prepared.center[face] - center;
            const float beta = normal.dot(offset);
            const float alpha = std::sqrt(std::max(offset.squaredNorm() - beta * beta, 0.0F));
            splat(image, alpha, beta, prepared.samples.area_share[s] * agreement);
        }
        // alpha is never negative: the margin before the first bin holds points within half a bin of the axis.
        for (std::size_t i = 0; i < k_side; ++i) {
            for (std::size_t j = 0; j < k_side; ++j) {
                const float inner = i == 0 ? image[j + 1] : 0.0F;
                matrix.column(i * k_side + j)[f] = image[(i + 1) * k_padded + j + 1] + inner;
            }
        }
    };
    parallel_for(prepared.face_count(), measure, 64);
    return matrix;
}

}  // namespace exemplar
