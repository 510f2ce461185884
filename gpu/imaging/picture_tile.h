#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace exemplar {

/// A part of a picture that is drawn at once, in pixels.
struct PictureTile {
    int x, y;  ///< of its upper left pixel
    int width, height;
};

/// Calls use(PictureTile) for tiles of at most `size` pixels a side that cover a picture, row by row.
template <typename Use>
void for_each_tile(int width, int height, int size, Use&& use) {
    for (int y = 0; y < height; y += size)
        for (int x = 0; x < width; x += size)
            use(PictureTile{x, y, std::min(size, width - x), std::min(size, height - y)});
}

/// Returns the matrix that maps to the tile's clip space, given one that maps to the clip space of a picture of
/// width x height pixels.
inline Eigen::Matrix4f tile_matrix(Eigen::Matrix4f matrix, const PictureTile& tile, int width, int height) {
    // Stretches the part [begin, begin + size) of `whole` pixels to the full clip space along one axis.
    const auto zoom = [&](int axis, int begin, int size, int whole) {
        const float center = static_cast<float>(2 * begin + size) / static_cast<float>(whole) - 1;
        matrix.row(axis) =
            (matrix.row(axis) - center * matrix.row(3)) * (static_cast<float>(whole) / static_cast<float>(size));
    };
    zoom(0, tile.x, tile.width, width);
    zoom(1, tile.y, tile.height, height);
    return matrix;
}

}  // namespace exemplar
