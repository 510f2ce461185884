#include "host/mesh/labels.h"

#include <algorithm>
#include <cmath>

namespace exemplar {
namespace {

/// Greedy farthest points in CIE L*a*b*, away from black, white and gray. The first nine have moderate chroma, since
/// most meshes have no more labels. Any two colors are at least 38 apart there (1 is barely visible).
constexpr std::array<Color, 20> k_palette{
    {{212, 80, 64},  {64, 120, 200},  {56, 212, 128}, {200, 176, 56}, {176, 44, 140},  {20, 212, 236}, {248, 176, 224},
     {80, 116, 56},  {248, 176, 140}, {32, 20, 248},  {32, 236, 20},  {248, 20, 248},  {128, 92, 236}, {116, 68, 80},
     {248, 140, 20}, {20, 104, 116},  {248, 20, 116}, {176, 224, 20}, {176, 212, 176}, {128, 80, 20}}};

}  // namespace

Color label_color(std::size_t label) {
    Color color = k_palette[label % k_palette.size()];
    const std::size_t round = label / k_palette.size() % 3;
    for (std::uint8_t& channel : color) {
        const int value = channel;
        if (round == 1) channel = static_cast<std::uint8_t>(value * 11 / 20);            // darker
        if (round == 2) channel = static_cast<std::uint8_t>(value + (255 - value) / 2);  // lighter
    }
    return color;
}

std::array<double, 3> linear_color(const Color& color) {
    std::array<double, 3> linear{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double s = color[c] / 255.0;
        linear[c] = std::round(1e5 * (s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4))) / 1e5;
    }
    return linear;
}

}  // namespace exemplar
