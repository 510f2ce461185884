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

/// What the strokes of a drawing are to look like around each pixel (thesis Sec. 4.2): the targets of synthesis, and
/// what a known rule says. All are images of the same size, row by row from the top left; pixel (x, y) has its center
/// at (x + 0.5, y + 0.5), x to the right, y down.
struct HatchingFields {
    int width = 0, height = 0;
    std::vector<std::uint8_t> level;  ///< h: 0 where nothing is hatched, and outside of the object
    /// phi_1 and phi_2: directions of hatches and cross-hatches, radians in [0, pi) from the x axis towards the y axis
    /// (clockwise on the screen). The first counts where the level is 1 or 2, the second where it is 2.
    std::array<std::vector<float>, k_hatch_layers> orientation;
    std::vector<float> thickness;  ///< t: width of strokes, pixels, positive where the level is not 0; so are the rest
    std::vector<float> intensity;  ///< I: how dark strokes are, in (0, 1]: 1 black, 0 the paper
    std::vector<float> spacing;    ///< d: between the center lines of neighboring strokes of a family, pixels
    std::vector<float> length;     ///< l: of strokes, pixels

    HatchingFields() = default;
    /// Of that size, all zero.
    HatchingFields(int image_width, int image_height);

    std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// The angle between two directions without sign, each in radians: in [0, pi / 2].
float orientation_difference(float first, float second);

}  // namespace exemplar
