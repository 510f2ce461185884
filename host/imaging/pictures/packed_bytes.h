#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace exemplar {

// Each decoder fills `out` from the bytes of a strip or tile, and returns whether these sufficed and were valid. Bytes
// beyond are ignored.

/// Decodes PackBits: a signed byte n, then n + 1 bytes as they are, or one byte that is repeated 1 - n times.
bool unpack_bits(std::string_view bytes, std::span<std::uint8_t> out);
/// Decodes the LZW of TIFF: codes of 9 to 12 bits, the high bit first, 256 to begin anew, 257 at the end.
bool unpack_lzw(std::string_view bytes, std::span<std::uint8_t> out);
/// Decodes Deflate in the frame of zlib.
bool unpack_deflate(std::string_view bytes, std::span<std::uint8_t> out);

}  // namespace exemplar
