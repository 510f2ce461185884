#include "host/hatching/rules/held_out_patches.h"

#include "host/core/statistics.h"
#include "host/hatching/rules/orientation_samples.h"

namespace exemplar {

std::vector<std::uint8_t> held_out_patches(const PixelFeatures& pixels, const DrawingProperties& drawing,
                                           std::span<const std::uint32_t> rows, std::uint64_t seed) {
    constexpr double k_share = 0.25, k_least_side = 3, k_largest_side = 10;
    const auto width = static_cast<std::uint32_t>(drawing.width);
    std::vector<std::uint16_t> x, y;
    std::vector<float> spacings;
    for (const std::uint32_t row : rows) {
        const std::uint32_t pixel = pixels.pixels().pixel[row];
        x.push_back(static_cast<std::uint16_t>(pixel % width));
        y.push_back(static_cast<std::uint16_t>(pixel / width));
        const float spacing = drawing.property[static_cast<std::size_t>(StrokeProperty::spacing)][pixel];
        if (spacing > 0) spacings.push_back(spacing);
    }
    const auto usual = static_cast<double>(upper_median(spacings));
    const std::vector<std::uint32_t> one_group(rows.size());
    return held_out_rectangles(x, y, one_group, k_share, seed, {k_least_side * usual, k_largest_side * usual});
}

}  // namespace exemplar
