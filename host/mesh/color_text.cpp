#include "host/mesh/color_text.h"

#include <fmt/format.h>

#include <charconv>

namespace exemplar {

std::string hex_of_color(const Color& color) {
    return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

std::optional<Color> color_of_hex(std::string_view text) {
    if ((text.size() != 4 && text.size() != 7) || text[0] != '#') return std::nullopt;
    const std::size_t digits = text.size() / 3;  // of each channel
    Color color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const char* const begin = text.data() + 1 + c * digits;
        std::uint8_t value = 0;
        const auto [end, error] = std::from_chars(begin, begin + digits, value, 16);
        if (error != std::errc() || end != begin + digits) return std::nullopt;
        color[c] = digits == 1 ? static_cast<std::uint8_t>(17 * value) : value;
    }
    return color;
}

}  // namespace exemplar
