#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/mesh/labels.h"

namespace exemplar {

/// Returns a color as "#rrggbb".
std::string hex_of_color(const Color& color);
/// Reads "#rrggbb" or "#rgb", in letters of either case; nullopt for anything else.
std::optional<Color> color_of_hex(std::string_view text);

}  // namespace exemplar
