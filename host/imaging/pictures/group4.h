#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace exemplar {

/// Decodes CCITT Group 4 (ITU-T T.6), as fax machines and scanners write line art: rows of `width` pixels, eight in a
/// byte, the left one in the high bit, 1 is black. `out` holds whole rows of (width + 7) / 8 bytes, zero before.
/// Returns whether the bytes were valid and sufficed.
bool unpack_group4(std::string_view bytes, std::uint32_t width, std::span<std::uint8_t> out);

}  // namespace exemplar
