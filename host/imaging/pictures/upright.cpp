#include "host/imaging/pictures/upright.h"

#include <algorithm>
#include <utility>

namespace exemplar {

Image upright(Image picture, std::uint32_t orientation) {
    if (orientation == 1) return picture;
    const bool swapped = orientation >= 5;  // rows are columns
    const int w = picture.width, h = picture.height;
    Image turned(swapped ? h : w, swapped ? w : h, picture.channels);
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
    const bool from_below = orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
    for (int y = 0; y < turned.height; ++y)
        for (int x = 0; x < turned.width; ++x) {
            const int column = swapped ? y : x, row = swapped ? x : y;
            const auto from =
                std::as_const(picture).pixel(from_right ? w - 1 - column : column, from_below ? h - 1 - row : row);
            std::copy(from.begin(), from.end(), turned.pixel(x, y).begin());
        }
    return turned;
}

}  // namespace exemplar
