#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Calls body(pixel, x, y) for the pixels whose centers are within `reach` of a point, with their index and the way
/// from there to the point, in units of 2^near_shift.
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

/// How near the strokes of each layer are that have been placed: per pixel, the nearest of their points. A word has the
/// pixel's distance to it (10 bits) and the way from the center of the pixel to it (11 bits each for x and y, offset by
/// 1024), in units of 2^near_shift; so the nearest is the least, whatever the order in which they come.
class Clearance {
  public:
    static constexpr std::uint32_t k_far = 0xffffffffU;

    /// `grid` must live as long as this.
    explicit Clearance(const PlacementGrid& grid);

    /// Notes the points of a stroke around all pixels within near_reach() of the spacing there. May be called from many
    /// threads at once.
    void add(const FineStroke& stroke);

    /// The squared distance from a point in the picture to the nearest of the points that the four pixels around it
    /// know, in squared units of 2^near_shift; k_far if they know none.
    std::uint32_t squared_distance(std::uint32_t layer, FinePoint point) const;
    /// Whether a point of a spacing is so far from all strokes, in shares of it.
    bool is_clear(std::uint32_t layer, FinePoint point, std::int32_t spacing, std::int32_t share) const {
        const auto least = static_cast<std::uint32_t>(share_of_spacing(spacing, share) >> grid_.rules.near_shift);
        return squared_distance(layer, point) >= least * least;
    }

    /// The words, layer by layer.
    const std::vector<std::uint32_t>& words() const { return words_; }

  private:
    const PlacementGrid& grid_;
    std::vector<std::uint32_t> words_;
};

/// How far points of strokes are noted: a quarter over the spacing, and a pixel; in the units of positions.
std::int32_t near_reach(std::int32_t spacing);
/// Of a stroke, only every so manieth point is noted and claimed: four to a spacing are enough.
std::uint32_t noted_stride(std::int32_t spacing);

/// Whether the i-th of `count` points is: the last is always.
inline bool is_noted(std::size_t i, std::size_t count, std::int32_t spacing) {
    return i % noted_stride(spacing) == 0 || i + 1 == count;
}

/// The least of `word` and what is there remains; safe among threads.
inline void lower(std::uint32_t& there, std::uint32_t word) {
    const std::atomic_ref<std::uint32_t> shared(there);
    std::uint32_t seen = shared.load(std::memory_order_relaxed);
    while (word < seen && !shared.compare_exchange_weak(seen, word, std::memory_order_relaxed)) {
    }
}

}  // namespace exemplar
