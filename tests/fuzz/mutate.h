#pragma once

#include <array>
#include <string>

#include "host/core/random.h"

namespace exemplar::fuzz {

/// One random damage to a file's bytes: a cut, flipped bits, a part removed, doubled or moved, a decimal number or a
/// binary word replaced by an extreme one.
inline std::string damaged(std::string bytes, Random& random) {
    if (bytes.empty()) return bytes;
    const std::size_t at = random.index(bytes.size()),
                      length = 1 + random.index(std::min<std::size_t>(bytes.size() - at, 40));
    switch (random.index(8)) {
        case 0:
            return bytes.substr(0, at);
        case 1:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.index(8)));
            return bytes;
        case 2:
            bytes[at] = static_cast<char>(random.next() & 0xff);
            return bytes;
        case 3:
            return bytes.erase(at, length);
        case 4:
            return bytes.insert(random.index(bytes.size()), bytes.substr(at, length));
        case 5: {
            constexpr std::array<std::uint32_t, 6> k_words{0, 1, 0xffffffffu, 0x7fffffffu, 0x80000000u, 0x00ffffffu};
            const std::uint32_t word = k_words[random.index(k_words.size())];
            for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
                bytes[at + i] = static_cast<char>(word >> (8 * i));
            return bytes;
        }
        default:
            break;
    }
    constexpr std::string_view k_digits = "0123456789";
    constexpr std::array<std::string_view, 15> k_numbers{"0",
                                                         "-1",
                                                         "1",
                                                         "3",
                                                         "255",
                                                         "2147483647",
                                                         "-2147483648",
                                                         "4294967295",
                                                         "18446744073709551615",
                                                         "-9223372036854775808",
                                                         "1e999",
                                                         "nan",
                                                         "-inf",
                                                         "0.5",
                                                         ""};
    const std::size_t begin = bytes.find_first_of(k_digits, at);
    if (begin == std::string::npos) return bytes;
    const std::size_t end = std::min(bytes.find_first_not_of(k_digits, begin), bytes.size());
    return bytes.replace(begin, end - begin, k_numbers[random.index(k_numbers.size())]);
}

}  // namespace exemplar::fuzz
