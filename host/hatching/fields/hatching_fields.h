#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

/// Hatching levels (thesis Sec. 4.2): how many families of strokes cross a pixel.
constexpr std::uint8_t k_no_hatching = 0, k_single_hatching = 1, k_cross_hatching = 2;
/// The two families of strokes: hatches, and the hatches that cross them.
constexpr std::size_t k_hatch_layers = 2;

/// Target properties of the strokes around each pixel (thesis Sec. 4.2), as predicted by a style or given by a known
/// rule. All are images of the same size, row by row from the top left. The center of pixel (x, y) lies at (x + 0.5,
/// y + 0.5), x to the right, y down.
struct HatchingFields {
    int width = 0, height = 0;
    std::vector<std::uint8_t> level;  ///< h: 0 where nothing is hatched, and outside of the object
    /// phi_1 and phi_2: directions of hatches and cross-hatches, radians in [0, pi) from the x axis towards the y
    /// axis (clockwise on the screen). The first is valid where the level is 1 or 2, the second where it is 2.
    std::array<std::vector<float>, k_hatch_layers> orientation;
    std::vector<float> thickness;  ///< t: stroke width, pixels; like all below, positive where the level is not 0
    std::vector<float> intensity;  ///< I: darkness of strokes, in (0, 1]: 1 is black, 0 is paper
    std::vector<float> spacing;    ///< d: between center lines of neighboring strokes of a family, pixels
    std::vector<float> length;     ///< l: stroke length, pixels

    HatchingFields() = default;
    /// Makes fields of that size, all zero.
    HatchingFields(int image_width, int image_height);

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// Returns the angle between two unsigned directions, all in radians; the result is in [0, pi / 2].
float orientation_difference(float first, float second);

}  // namespace exemplar
