#include "host/mesh/labels.h"

#include <algorithm>

namespace exemplar {
namespace {

/// Greedy farthest points in CIE L*a*b* among saturated colors of middle lightness, away from black, white and gray:
/// any two are at least 37 apart there (1 is barely visible).
constexpr std::array<Color, 20> k_palette{
    {{212, 68, 56},   {56, 116, 200}, {20, 248, 20},  {248, 20, 248},  {248, 212, 32}, {20, 248, 200},  {20, 92, 20},
     {248, 128, 200}, {20, 68, 236},  {68, 212, 248}, {188, 200, 128}, {104, 68, 20},  {248, 176, 164}, {140, 20, 152},
     {92, 176, 20},   {116, 56, 92},  {248, 140, 20}, {248, 20, 116},  {20, 128, 116}, {200, 188, 248}}};

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

}  // namespace exemplar
