#include "host/lines/strokes/stroke_textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "host/core/random.h"
#include "host/imaging/png.h"

namespace exemplar {

namespace {

constexpr int k_length = 256, k_breadth = 32;
constexpr std::array k_texture_names = {std::string_view("pencil"), std::string_view("charcoal"),
                                        std::string_view("brush")};

/// Smooth noise in [0, 1] with cells of cell_x x cell_y pixels, periodic in x.
class Noise {
  public:
    Noise(int cell_x, int cell_y, std::uint64_t seed)
        : cell_x_(cell_x),
          cell_y_(cell_y),
          columns_(k_length / cell_x),
          values_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(k_breadth / cell_y + 2)) {
        Random random(seed);
        for (float& value : values_) value = static_cast<float>(random.uniform());
    }
    float at(int x, int y) const {
        const int i = x / cell_x_, j = y / cell_y_;
        const float s = smooth(static_cast<float>(x % cell_x_) / static_cast<float>(cell_x_));
        const float t = smooth(static_cast<float>(y % cell_y_) / static_cast<float>(cell_y_));
        const float top = std::lerp(value(i, j), value(i + 1, j), s);
        return std::lerp(top, std::lerp(value(i, j + 1), value(i + 1, j + 1), s), t);
    }

  private:
    static float smooth(float x) { return x * x * (3 - 2 * x); }
    float value(int i, int j) const {
        const auto row = static_cast<std::size_t>(j), column = static_cast<std::size_t>(i % columns_);
        return values_[row * static_cast<std::size_t>(columns_) + column];
    }
    int cell_x_, cell_y_, columns_;
    std::vector<float> values_;
};

float rise(float from, float to, float x) {
    const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

template <typename Opacity>
Image make_texture(Opacity&& opacity) {
    Image image(k_length, k_breadth, 1);
    for (int y = 0; y < k_breadth; ++y)
        for (int x = 0; x < k_length; ++x) {
            const float across = (2 * static_cast<float>(y) + 1) / k_breadth - 1;
            const float value = std::clamp(opacity(x, y, std::abs(across)), 0.0f, 1.0f);
            image.pixel(x, y)[0] = static_cast<std::uint8_t>(std::lround(255 * value));
        }
    return image;
}

/// Graphite catches on the grain of the paper, less in the middle where the point presses.
Image pencil() {
    const Noise grain(2, 2, 11), coarse(8, 4, 12), pressure(64, 32, 13);
    return make_texture([&](int x, int y, float across) {
        const float paper = 0.65f * grain.at(x, y) + 0.35f * coarse.at(x, y);
        const float press = 1 - 0.75f * across * across + 0.25f * (pressure.at(x, 0) - 0.5f);
        return rise(0.95f - press, 1.35f - press, paper);
    });
}

/// Coarser grain, gaps along the stroke, and a ragged edge.
Image charcoal() {
    const Noise grain(2, 2, 21), coarse(4, 4, 22), patches(32, 8, 23), edge(4, 32, 24);
    return make_texture([&](int x, int y, float across) {
        const float paper = 0.5f * grain.at(x, y) + 0.3f * coarse.at(x, y) + 0.2f * patches.at(x, y);
        const float inside = 1 - rise(0.55f, 1, across + 0.35f * (edge.at(x, 0) - 0.5f));
        return inside * rise(0.28f, 0.62f, paper);
    });
}

/// Bristles leave streaks along the stroke, more of them at the sides.
Image brush() {
    const Noise bristles(128, 1, 31), streaks(32, 2, 32), edge(16, 32, 33);
    return make_texture([&](int x, int y, float across) {
        const float ink = 0.6f * bristles.at(x, y) + 0.4f * streaks.at(x, y);
        const float inside = 1 - rise(0.85f, 1, across + 0.1f * edge.at(x, 0));
        return inside * rise(0.05f + 0.3f * across * across, 0.2f + 0.4f * across * across, ink);
    });
}

Image opacity_of(const Image& image) {
    Image gray(image.width, image.height, 1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto pixel = image.pixel(x, y);
            int sum = 0;
            const int colors = std::min(image.channels, 3);
            for (int c = 0; c < colors; ++c) sum += pixel[static_cast<std::size_t>(c)];
            gray.pixel(x, y)[0] = image.channels == 4 ? pixel[3] : static_cast<std::uint8_t>(255 - sum / colors);
        }
    return gray;
}

}  // namespace

std::span<const std::string_view> stroke_texture_names() {
    return k_texture_names;
}

Image load_stroke_texture(const std::string& name) {
    if (name == "none") return {};
    if (name == "pencil") return pencil();
    if (name == "charcoal") return charcoal();
    if (name == "brush") return brush();
    return opacity_of(read_png(name));
}

float sample_stroke_texture(const Image& texture, float parameter, float across) {
    if (texture.data.empty()) return 1;
    const auto width = static_cast<float>(texture.width), height = static_cast<float>(texture.height);
    float x = parameter - 0.5f;
    x -= width * std::floor(x / width);
    const float y = std::clamp((across + 1) * 0.5f * height - 0.5f, 0.0f, height - 1);
    const int left = std::min(static_cast<int>(x), texture.width - 1), right = (left + 1) % texture.width;
    const int top = static_cast<int>(y), bottom = std::min(top + 1, texture.height - 1);
    const float s = x - std::floor(x), t = y - static_cast<float>(top);
    const auto at = [&](int i, int j) { return static_cast<float>(texture.pixel(i, j)[0]); };
    return std::lerp(std::lerp(at(left, top), at(right, top), s), std::lerp(at(left, bottom), at(right, bottom), s),
                     t) /
           255;
}

}  // namespace exemplar
