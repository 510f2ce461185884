#include "host/imaging/bilinear.h"

#include <algorithm>
#include <cmath>

namespace exemplar {

float sample_bilinear(const FloatImage& image, const Vec2& place, ImageBorder border) {
    const auto width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    float x = place.x() - 0.5f, y = place.y() - 0.5f;
    if (border == ImageBorder::nearest) {
        x = std::clamp(x, 0.0f, width - 1);
        y = std::clamp(y, 0.0f, height - 1);
    } else if (!(x >= -1 && y >= -1 && x < width && y < height)) {
        return 0;
    }
    // With a clamped place, pixels outside have no share.
    const auto value = [&](int column, int row) {
        const bool inside = column >= 0 && row >= 0 && column < image.width && row < image.height;
        return inside ? image.pixel(column, row)[0] : 0.0f;
    };
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    const float right_share = x - static_cast<float>(left), lower_share = y - static_cast<float>(top);
    const float upper = std::lerp(value(left, top), value(left + 1, top), right_share);
    const float lower = std::lerp(value(left, top + 1), value(left + 1, top + 1), right_share);
    return std::lerp(upper, lower, lower_share);
}

}  // namespace exemplar
