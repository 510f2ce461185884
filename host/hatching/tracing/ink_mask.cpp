#include "host/hatching/tracing/ink_mask.h"

#include <algorithm>
#include <array>

#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr int k_comparison_reach = 3;    ///< radius of the surroundings of a pixel, pixels
constexpr float k_valley_depth = 0.2f;   ///< min depth of a valley, in units of the darkest pixel around
constexpr float k_crest_height = 0.35f;  ///< min height of a crest, in units of its own darkness
constexpr std::array<std::array<int, 2>, 4> k_directions{{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};

/// Returns the largest value in the square of 2 k_comparison_reach + 1 pixels around each pixel.
FloatImage largest_around(const FloatImage& image) {
    FloatImage along(image.width, image.height, 1), largest(image.width, image.height, 1);
    const auto rows = static_cast<std::size_t>(image.height);
    parallel_for(
        rows,
        [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < image.width; ++x) {
                float value = 0;
                for (int k = std::max(0, x - k_comparison_reach);
                     k <= std::min(image.width - 1, x + k_comparison_reach); ++k)
                    value = std::max(value, image.pixel(k, y)[0]);
                along.pixel(x, y)[0] = value;
            }
        },
        16);
    parallel_for(
        rows,
        [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int k = std::max(0, y - k_comparison_reach); k <= std::min(image.height - 1, y + k_comparison_reach);
                 ++k)
                for (int x = 0; x < image.width; ++x)
                    largest.pixel(x, y)[0] = std::max(largest.pixel(x, y)[0], along.pixel(x, k)[0]);
        },
        16);
    return largest;
}

/// The lightest and the darkest pixel on one side of a pixel, and the one next to it.
struct Side {
    float lightest, darkest, next;
};

Side side_of(const FloatImage& image, int x, int y, int dx, int dy) {
    Side side{1e9f, 0, 0};
    for (int k = 1; k <= k_comparison_reach; ++k) {
        const int px = std::clamp(x + k * dx, 0, image.width - 1), py = std::clamp(y + k * dy, 0, image.height - 1);
        const float value = image.pixel(px, py)[0];
        side.lightest = std::min(side.lightest, value);
        side.darkest = std::max(side.darkest, value);
        if (k == 1) side.next = value;
    }
    return side;
}

bool is_ink(const FloatImage& darkness, int x, int y, float around) {
    const float here = darkness.pixel(x, y)[0];
    bool valley = false;
    for (const auto& [dx, dy] : k_directions) {
        const Side first = side_of(darkness, x, y, dx, dy), second = side_of(darkness, x, y, -dx, -dy);
        if (here >= std::max(first.next, second.next) &&
            std::max(first.lightest, second.lightest) < (1 - k_crest_height) * here)
            return true;
        valley |= std::min(first.darkest, second.darkest) > here + k_valley_depth * around;
    }
    return here >= 0.5f * around && !valley;
}

}  // namespace

PixelMask ink_pixels(const FloatImage& darkness, float min_darkness) {
    PixelMask ink(darkness.width, darkness.height, 1);
    const FloatImage around = largest_around(darkness);
    parallel_for(
        static_cast<std::size_t>(darkness.height),
        [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < darkness.width; ++x)
                if (darkness.pixel(x, y)[0] >= min_darkness)
                    ink.pixel(x, y)[0] = is_ink(darkness, x, y, around.pixel(x, y)[0]);
        },
        16);
    return ink;
}

}  // namespace exemplar
