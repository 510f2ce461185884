#include "host/hatching/fields/occlusion_barriers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr float k_explained_slope = 2, k_min_jump = 1.0f / 200;

/// Depths along a row or a column.
struct DepthLine {
    const float* first;
    std::size_t step;
    int count;

    float operator[](int i) const { return first[static_cast<std::size_t>(i) * step]; }
    /// Change of depth from i to i + 1; 0 where either is background or outside of the image.
    float slope(int i) const {
        if (i < 0 || i + 1 >= count) return 0;
        const float slope = (*this)[i + 1] - (*this)[i];
        return std::isfinite(slope) ? slope : 0;
    }
    /// Whether depth jumps between i and i + 1.
    bool jumps(int i, float least) const {
        const bool here = std::isfinite((*this)[i]), there = std::isfinite((*this)[i + 1]);
        if (!here || !there) return here != there;
        const float step_there = slope(i), sign = step_there < 0 ? -1.0f : 1.0f;
        const float beside = std::max({0.0f, sign * slope(i - 1), sign * slope(i + 1)});
        return std::abs(step_there) > k_explained_slope * beside + least;
    }
};

float depth_range(std::span<const float> depth) {
    float low = std::numeric_limits<float>::max(), high = -low;
    for (const float value : depth)
        if (std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    return std::max(high - low, 0.0f);
}

}  // namespace

std::vector<std::uint8_t> occlusion_barriers(std::span<const float> depth, int width, int height) {
    if (width < 0 || height < 0 || depth.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw UsageError(fmt::format("{} depths are not those of {} x {} pixels", depth.size(), width, height));
    std::vector<std::uint8_t> barriers(depth.size());
    const float least = k_min_jump * depth_range(depth);
    const auto row = static_cast<std::size_t>(width);
    parallel_for(
        static_cast<std::size_t>(height),
        [&](std::size_t y) {
            const DepthLine along{depth.data() + y * row, 1, width};
            for (std::size_t x = 0; x < row; ++x) {
                const DepthLine down{depth.data() + x, row, height};
                std::uint8_t& bits = barriers[y * row + x];
                if (x + 1 < row && along.jumps(static_cast<int>(x), least)) bits |= k_barrier_right;
                if (static_cast<int>(y) + 1 < height && down.jumps(static_cast<int>(y), least)) bits |= k_barrier_below;
            }
        },
        8);
    return barriers;
}

}  // namespace exemplar
