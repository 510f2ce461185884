#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// An image of interleaved channels, row by row from the top left. 1 channel is gray, 3 are RGB, 4 RGBA.
template <typename T>
struct BasicImage {
    int width = 0, height = 0, channels = 0;
    std::vector<T> data;  ///< height x width x channels

    BasicImage() = default;
    BasicImage(int image_width, int image_height, int image_channels, T value = T{})
        : width(image_width),
          height(image_height),
          channels(image_channels),
          data(static_cast<std::size_t>(image_width) * static_cast<std::size_t>(image_height) *
                   static_cast<std::size_t>(image_channels),
               value) {}

    /// The channels of pixel (x, y); 0 <= x < width, 0 <= y < height.
    std::span<T> pixel(int x, int y) { return {data.data() + offset(x, y), static_cast<std::size_t>(channels)}; }
    std::span<const T> pixel(int x, int y) const {
        return {data.data() + offset(x, y), static_cast<std::size_t>(channels)};
    }
    bool operator==(const BasicImage&) const = default;

  private:
    std::size_t offset(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels);
    }
};

/// 8-bit image; colors are sRGB-encoded, alpha is linear and not premultiplied.
using Image = BasicImage<std::uint8_t>;
/// Linear or unitless values, by context.
using FloatImage = BasicImage<float>;

/// Images of one size with one channel, stored one after the other, each row by row from the top left.
struct ImageStack {
    int width = 0, height = 0;
    std::size_t count = 0;
    std::vector<float> values;  ///< count x height x width

    ImageStack() = default;
    ImageStack(int image_width, int image_height, std::size_t image_count, float value = 0)
        : width(image_width), height(image_height), count(image_count), values(image_count * pixels(), value) {}

    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
    std::span<float> image(std::size_t i) { return std::span(values).subspan(i * pixels(), pixels()); }
    std::span<const float> image(std::size_t i) const { return std::span(values).subspan(i * pixels(), pixels()); }
    float at(std::size_t i, int x, int y) const { return values[i * pixels() + index(x, y)]; }
    bool operator==(const ImageStack&) const = default;
};

}  // namespace exemplar
