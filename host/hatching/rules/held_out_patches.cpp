#include "host/hatching/rules/held_out_patches.h"

#include "host/core/statistics.h"
#include "host/hatching/rules/orientation_samples.h"

namespace exemplar {

std::vector<std::uint8_t> held_out_patches(const HatchingExamples& views, std::span<const std::uint32_t> rows,
                                           std::uint64_t seed) {
    constexpr double k_share = 0.25, k_least_side = 3, k_largest_side = 10;
    std::vector<std::uint16_t> x, y;
    std::vector<std::uint32_t> view;
    std::vector<float> spacings;
    for (const std::uint32_t row : rows) {
        const auto [at_x, at_y] = views.place_of(row);
        x.push_back(at_x);
        y.push_back(at_y);
        view.push_back(static_cast<std::uint32_t>(views.view_of(row)));
        const float spacing =
            views.drawing_of(row).property[static_cast<std::size_t>(StrokeProperty::spacing)][views.pixel_of(row)];
        if (spacing > 0) spacings.push_back(spacing);
    }
    const auto usual = static_cast<double>(upper_median(spacings));
    return held_out_rectangles(x, y, view, k_share, seed, {k_least_side * usual, k_largest_side * usual});
}

}  // namespace exemplar
