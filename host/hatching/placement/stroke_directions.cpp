#include "host/hatching/placement/stroke_directions.h"

#include <array>

#include "host/hatching/fields/occlusion_barriers.h"

namespace exemplar {
namespace {

/// Directions cancel out if their mean is shorter than this share of a unit vector.
constexpr std::int32_t k_min_agreement = 358;

std::int32_t signed_half(std::uint32_t word) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(word));
}

/// The four pixels around a point, [row][column], and which of them are reachable from its own pixel.
struct Corners {
    std::array<std::array<PlacementTexel, 2>, 2> texels;
    int home_x, home_y;

    bool free_along(int row) const { return !(texels[row][0].flags & k_barrier_right); }
    bool free_down(int column) const { return !(texels[0][column].flags & k_barrier_below); }
    bool reaches(int x, int y) const {
        const bool along = x != home_x, down = y != home_y;
        if (along && down) return (free_along(home_y) && free_down(x)) || (free_down(home_x) && free_along(y));
        return along ? free_along(home_y) : !down || free_down(home_x);
    }
};

/// Returns the direction at half the angle of (c, s), a vector of that length, with the sign nearer to `heading`.
Direction half_angle(std::int32_t c, std::int32_t s, std::int32_t length, Direction heading) {
    // Both formulas give the half angle; the chosen one does not cancel.
    const Direction half = c >= 0 ? direction_of(length + c, s) : direction_of(s, length - c);
    return dot(half, heading) < 0 ? -half : half;
}

}  // namespace

Direction direction_at(const PlacementGrid& grid, std::uint32_t layer, FinePoint point, Direction heading) {
    const PlacementTexel* home = grid.at(point);
    if (!home || !home->hatched(layer)) return {};
    const std::int32_t x = point.x - k_pixel / 2, y = point.y - k_pixel / 2;
    const int left = x >> k_pixel_bits, top = y >> k_pixel_bits;
    Corners corners{{}, (point.x >> k_pixel_bits) - left, (point.y >> k_pixel_bits) - top};
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i)
            if (grid.inside(left + i, top + j)) corners.texels[j][i] = grid.at(left + i, top + j);

    const std::int32_t right_part = (x & (k_pixel - 1)) >> 4, lower_part = (y & (k_pixel - 1)) >> 4;
    std::int32_t c = 0, s = 0, total = 0;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const std::uint32_t word = corners.texels[j][i].directions[layer];
            if (word == 0 || !corners.reaches(i, j)) continue;
            const std::int32_t weight = (i ? right_part : 256 - right_part) * (j ? lower_part : 256 - lower_part);
            c += weight * signed_half(word);
            s += weight * signed_half(word >> 16);
            total += weight;
        }
    c = (c + (1 << 15)) >> 16;
    s = (s + (1 << 15)) >> 16;
    const auto length = static_cast<std::int32_t>(floor_sqrt(static_cast<std::uint32_t>(c * c + s * s)));
    // The weights of all four pixels are 2^16 together, directions 2^14 long and shares 2^10.
    if (length == 0 || length << 12 < total * k_min_agreement) return {};
    return half_angle(c, s, length, heading);
}

}  // namespace exemplar
