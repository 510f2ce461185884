#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Calls body(pixel, x, y) for every pixel whose center is within `reach` of a point, with its index and the vector
/// from its center to the point, in units of 2^near_shift.
template <typename Body>
void for_pixels_within(const PlacementGrid& grid, FinePoint point, std::int32_t reach, Body&& body) {
    const int shift = grid.rules.near_shift, pixels = (reach >> k_pixel_bits) + 1;
    const int x = point.x >> k_pixel_bits, y = point.y >> k_pixel_bits;
    const std::int32_t most = (reach >> shift) * (reach >> shift);
    for (int j = std::max(y - pixels, 0); j <= std::min(y + pixels, grid.height - 1); ++j)
        for (int i = std::max(x - pixels, 0); i <= std::min(x + pixels, grid.width - 1); ++i) {
            const std::int32_t way_x = (point.x - i * k_pixel - k_pixel / 2) >> shift;
            const std::int32_t way_y = (point.y - j * k_pixel - k_pixel / 2) >> shift;
            if (way_x * way_x + way_y * way_y <= most) body(grid.index(i, j), way_x, way_y);
        }
}

/// Clearance map: per layer and pixel, the nearest point of the placed strokes. A word packs its distance from the
/// center of the pixel (10 bits, the highest) and the vector from the center to it (11 bits each for x and y, offset
/// by 1024), in units of 2^near_shift. The nearest point has the smallest word, so the order of insertion does not
/// matter.
class Clearance {
  public:
    static constexpr std::uint32_t k_far = 0xffffffffU;

    /// Keeps a reference to `grid`.
    explicit Clearance(const PlacementGrid& grid);

    /// Records the points of a stroke at all pixels within clearance_radius() of the spacing there. Thread-safe.
    void add(const FineStroke& stroke);

    /// Returns the squared distance from a point in the picture to the nearest of the points recorded at the four
    /// pixels around it, in squared units of 2^near_shift; k_far if there are none.
    std::uint32_t squared_distance(std::uint32_t layer, FinePoint point) const;
    /// Returns whether a point is at least `share` of `spacing` away from all strokes of a layer.
    bool is_clear(std::uint32_t layer, FinePoint point, std::int32_t spacing, std::int32_t share) const {
        const auto least = static_cast<std::uint32_t>(share_of_spacing(spacing, share) >> grid_.rules.near_shift);
        return squared_distance(layer, point) >= least * least;
    }

    /// Returns the words, layer by layer.
    const std::vector<std::uint32_t>& words() const { return words_; }

  private:
    const PlacementGrid& grid_;
    std::vector<std::uint32_t> words_;
};

/// Returns the radius in which stroke points are recorded, in units of positions: 1.25 spacings and a pixel.
std::int32_t clearance_radius(std::int32_t spacing);
/// Returns the stride of the stroke points that are recorded and claimed: four per spacing are enough.
std::uint32_t recorded_stride(std::int32_t spacing);

/// Returns whether the i-th of `count` points is recorded; the last one always is.
inline bool is_recorded(std::size_t i, std::size_t count, std::int32_t spacing) {
    return i % recorded_stride(spacing) == 0 || i + 1 == count;
}

/// Sets `there` to the minimum of itself and `word`, atomically.
inline void atomic_min(std::uint32_t& there, std::uint32_t word) {
    const std::atomic_ref<std::uint32_t> shared(there);
    std::uint32_t seen = shared.load(std::memory_order_relaxed);
    while (word < seen && !shared.compare_exchange_weak(seen, word, std::memory_order_relaxed)) {
    }
}

}  // namespace exemplar
