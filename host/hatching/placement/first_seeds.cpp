#include <cstdlib>
#include <unordered_map>
#include <unordered_set>

#include "host/core/disjoint_sets.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/placement/stroke_front.h"

namespace exemplar {
namespace {

/// Parts end where directions of neighboring pixels differ by over 30 degrees: the cosine of twice that, times
/// k_unit.
constexpr std::int32_t k_part_cosine = k_unit / 2;
/// Minimum area of a part, in squares of one spacing; smaller ones are left to the search for holes.
constexpr std::uint64_t k_least_squares = 9;

Direction unpacked_direction(std::uint32_t word) {
    return {static_cast<std::int16_t>(word & 0xffffU), static_cast<std::int16_t>(word >> 16)};
}

/// Returns the parts of a layer as disjoint sets of pixels.
DisjointSets find_parts(const PlacementGrid& grid, std::uint32_t layer) {
    DisjointSets parts(grid.size());
    const auto join = [&](std::size_t a, std::size_t b, std::uint32_t barrier) {
        const PlacementTexel &one = grid.texels[a], &other = grid.texels[b];
        if (one.hatched(layer) && other.hatched(layer) && !(one.flags & barrier) &&
            dot(unpacked_direction(one.directions[layer]), unpacked_direction(other.directions[layer])) >
                k_part_cosine * k_unit)
            parts.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
    };
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            if (x + 1 < grid.width) join(grid.index(x, y), grid.index(x + 1, y), k_barrier_right);
            if (y + 1 < grid.height) join(grid.index(x, y), grid.index(x, y + 1), k_barrier_below);
        }
    return parts;
}

/// Sums over the pixels of a part, and the pixel nearest to its centroid.
struct DirectionPart {
    std::uint64_t pixels = 0, x = 0, y = 0;
    std::uint64_t nearest = ~std::uint64_t{0};
    std::uint32_t seed = 0;

    void add(int pixel_x, int pixel_y) {
        ++pixels;
        x += static_cast<std::uint64_t>(pixel_x);
        y += static_cast<std::uint64_t>(pixel_y);
    }
    void try_seed(std::uint32_t pixel, int pixel_x, int pixel_y) {
        const auto off = [this](std::uint64_t sum, int at) {
            return static_cast<std::int64_t>(sum / pixels) - static_cast<std::int64_t>(at);
        };
        const std::int64_t off_x = off(x, pixel_x), off_y = off(y, pixel_y);
        const auto distance = static_cast<std::uint64_t>(off_x * off_x + off_y * off_y);
        if (distance >= nearest) return;
        nearest = distance;
        seed = pixel;
    }
};

/// The seeds of a layer, in the order of their parts' first pixels.
class LayerSeeds {
  public:
    LayerSeeds(const PlacementGrid& grid, std::uint32_t layer)
        : grid_(grid), layer_(layer), sets_(find_parts(grid, layer)) {
        for_pixels([&](std::uint32_t pixel, int x, int y) { parts_[sets_.find(pixel)].add(x, y); });
        for_pixels([&](std::uint32_t pixel, int x, int y) { parts_[sets_.find(pixel)].try_seed(pixel, x, y); });
    }

    void leave_out(std::span<const FineStroke> kept) {
        for (const FineStroke& stroke : kept)
            for (const FinePoint& point : stroke.points)
                if (stroke.layer == layer_)
                    parts_.erase(sets_.find(
                        static_cast<std::uint32_t>(grid_.index(point.x >> k_pixel_bits, point.y >> k_pixel_bits))));
    }

    void append_to(std::vector<SeedQueue>& lists) {
        for_pixels([&](std::uint32_t pixel, int, int) {
            const auto part = parts_.find(pixel);  // a set is named by its first pixel
            if (part == parts_.end()) return;
            const std::uint32_t seed = part->second.seed, row = static_cast<std::uint32_t>(grid_.width);
            const auto spacing = static_cast<std::uint64_t>(grid_.texels[seed].spacing());
            if (part->second.pixels << (2 * k_spacing_bits) < k_least_squares * spacing * spacing) return;
            lists.push_back({SeedSource::part, layer_, (seed % row) * k_pixel + k_pixel / 2,
                             (seed / row) * k_pixel + k_pixel / 2, 0});
        });
    }

  private:
    template <typename Body>
    void for_pixels(Body&& body) const {
        for (int y = 0; y < grid_.height; ++y)
            for (int x = 0; x < grid_.width; ++x)
                if (grid_.at(x, y).hatched(layer_)) body(static_cast<std::uint32_t>(grid_.index(x, y)), x, y);
    }

    const PlacementGrid& grid_;
    std::uint32_t layer_;
    DisjointSets sets_;
    std::unordered_map<std::uint32_t, DirectionPart> parts_;
};

}  // namespace

std::vector<SeedQueue> first_seeds(const PlacementGrid& grid, std::span<const FineStroke> kept) {
    std::vector<SeedQueue> lists;
    for (std::uint32_t layer = 0; layer < k_hatch_layers; ++layer) {
        LayerSeeds seeds(grid, layer);
        seeds.leave_out(kept);
        seeds.append_to(lists);
    }
    return lists;
}

std::vector<SeedQueue> block_seeds(const PlacementGrid& grid) {
    std::vector<SeedQueue> lists;
    const int side = 1 << grid.rules.block_bits;
    const auto is_hatched = [&](int left, int top, std::uint32_t layer) {
        for (int y = top; y < std::min(top + side, grid.height); ++y)
            for (int x = left; x < std::min(left + side, grid.width); ++x)
                if (grid.at(x, y).hatched(layer)) return true;
        return false;
    };
    for (std::uint32_t layer = 0; layer < k_hatch_layers; ++layer)
        for (int top = 0; top < grid.height; top += side)
            for (int left = 0; left < grid.width; left += side)
                if (is_hatched(left, top, layer))
                    lists.push_back({SeedSource::block, layer, static_cast<std::uint32_t>(left),
                                     static_cast<std::uint32_t>(top), 0});
    return lists;
}

}  // namespace exemplar
