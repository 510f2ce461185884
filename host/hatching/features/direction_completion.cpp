#include "host/hatching/features/direction_completion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// A level of the image pyramid. The less is known of an element, the shorter it is; zero if nothing is known.
struct Level {
    int width, height;
    std::vector<DoubledAngle> values;

    DoubledAngle& at(int x, int y) {
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
    /// Returns the nearest element if (x, y) is outside of the image.
    const DoubledAngle& at(int x, int y) const {
        x = std::clamp(x, 0, width - 1);
        y = std::clamp(y, 0, height - 1);
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

float length_of(const DoubledAngle& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1]);
}

void add(DoubledAngle& sum, float weight, const DoubledAngle& v) {
    sum[0] += weight * v[0];
    sum[1] += weight * v[1];
}

/// Sums blocks of two by two elements; sums longer than 1 are scaled to unit length.
Level pulled(const Level& fine) {
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.values.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
    parallel_for(static_cast<std::size_t>(coarse.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < coarse.width; ++x) {
            DoubledAngle sum{};
            for (int k = 0; k < 4; ++k)
                if (2 * x + k % 2 < fine.width && 2 * y + k / 2 < fine.height)
                    add(sum, 1, fine.at(2 * x + k % 2, 2 * y + k / 2));
            const float length = length_of(sum);
            coarse.at(x, y) = length > 1 ? DoubledAngle{sum[0] / length, sum[1] / length} : sum;
        }
    });
    return coarse;
}

/// Interpolates a coarse level bilinearly at the center of a fine element.
DoubledAngle between(const Level& coarse, int x, int y) {
    const int left = (x - 1) >> 1, top = (y - 1) >> 1;
    const float right_share = x % 2 ? 0.25f : 0.75f, low_share = y % 2 ? 0.25f : 0.75f;
    DoubledAngle sum{};
    add(sum, (1 - right_share) * (1 - low_share), coarse.at(left, top));
    add(sum, right_share * (1 - low_share), coarse.at(left + 1, top));
    add(sum, (1 - right_share) * low_share, coarse.at(left, top + 1));
    add(sum, right_share * low_share, coarse.at(left + 1, top + 1));
    return sum;
}

/// Adds to elements shorter than 1 what they lack, from the coarse level.
void push(const Level& coarse, Level& fine) {
    parallel_for(static_cast<std::size_t>(fine.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < fine.width; ++x) {
            DoubledAngle& value = fine.at(x, y);
            const float length = length_of(value);
            if (length < 1) add(value, 1 - length, between(coarse, x, y));
        }
    });
}

}  // namespace

void complete_directions(int width, int height, std::span<DoubledAngle> image) {
    if (width < 0 || height < 0 || image.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
        throw UsageError(fmt::format("{} directions for an image of {} x {} pixels", image.size(), width, height));
    if (std::ranges::find(image, DoubledAngle{}) == image.end()) return;
    std::vector<Level> levels{{width, height, {image.begin(), image.end()}}};
    while (levels.back().width > 1 || levels.back().height > 1) levels.push_back(pulled(levels.back()));
    for (std::size_t l = levels.size() - 1; l-- > 0;) push(levels[l + 1], levels[l]);
    for (std::size_t i = 0; i < image.size(); ++i)
        if (image[i] == DoubledAngle{}) image[i] = normalized(levels[0].values[i]);
}

}  // namespace exemplar
