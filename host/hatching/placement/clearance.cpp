#include "host/hatching/placement/clearance.h"

#include <algorithm>

namespace exemplar {

constexpr int k_way_bits = 11;
constexpr std::int32_t k_way_offset = 1 << (k_way_bits - 1);

std::int32_t clearance_radius(std::int32_t spacing) {
    return share_of_spacing(spacing, (1 << k_share_bits) * 5 / 4) + k_pixel;
}

std::uint32_t recorded_stride(std::int32_t spacing) {
    return static_cast<std::uint32_t>(std::max(1, spacing >> (k_spacing_bits + 2)));
}

Clearance::Clearance(const PlacementGrid& grid) : grid_(grid), words_(k_hatch_layers * grid.size(), k_far) {}

void Clearance::add(const FineStroke& stroke) {
    std::uint32_t* const words = words_.data() + stroke.layer * grid_.size();
    for (std::size_t i = 0; i < stroke.points.size(); ++i) {
        const FinePoint point = stroke.points[i];
        const std::int32_t spacing = grid_.at(point)->spacing();
        if (!is_recorded(i, stroke.points.size(), spacing)) continue;
        for_pixels_within(grid_, point, clearance_radius(spacing),
                          [&](std::size_t pixel, std::int32_t x, std::int32_t y) {
                              const auto squared = static_cast<std::uint32_t>(x * x + y * y);
                              atomic_min(words[pixel], floor_sqrt(squared) << (2 * k_way_bits) |
                                                           static_cast<std::uint32_t>(x + k_way_offset) << k_way_bits |
                                                           static_cast<std::uint32_t>(y + k_way_offset));
                          });
    }
}

std::uint32_t Clearance::squared_distance(std::uint32_t layer, FinePoint point) const {
    constexpr std::uint32_t k_way_mask = (1U << k_way_bits) - 1;
    const int shift = grid_.rules.near_shift;
    const int left = (point.x - k_pixel / 2) >> k_pixel_bits, top = (point.y - k_pixel / 2) >> k_pixel_bits;
    std::uint32_t least = k_far;
    for (int j = std::max(top, 0); j <= std::min(top + 1, grid_.height - 1); ++j)
        for (int i = std::max(left, 0); i <= std::min(left + 1, grid_.width - 1); ++i) {
            const std::uint32_t word = words_[layer * grid_.size() + grid_.index(i, j)];
            if (word == k_far) continue;
            const std::int32_t way_x = static_cast<std::int32_t>(word >> k_way_bits & k_way_mask) - k_way_offset -
                                       ((point.x - i * k_pixel - k_pixel / 2) >> shift);
            const std::int32_t way_y = static_cast<std::int32_t>(word & k_way_mask) - k_way_offset -
                                       ((point.y - j * k_pixel - k_pixel / 2) >> shift);
            least = std::min(least, static_cast<std::uint32_t>(way_x * way_x + way_y * way_y));
        }
    return least;
}

}  // namespace exemplar
