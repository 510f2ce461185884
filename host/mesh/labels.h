#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace exemplar {

/// Label names and one label per face. Faces are the SOURCE faces of a mesh file (before triangulation).
struct FaceLabels {
    std::vector<std::string> names;
    std::vector<std::int32_t> label;  ///< index into names; -1 where unlabeled
};

using Color = std::array<std::uint8_t, 3>;
/// Returns a color from a fixed palette of well-separated sRGB colors; it repeats with another lightness after 20.
Color label_color(std::size_t label);
/// Returns the color's linear components, as materials of glTF have them, from its sRGB ones; rounded to five digits,
/// which is finer than eight bits.
std::array<double, 3> linear_color(const Color& color);
/// The color of faces without a label.
constexpr Color k_unlabeled_color{128, 128, 128};

}  // namespace exemplar
