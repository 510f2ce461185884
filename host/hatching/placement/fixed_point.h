#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace exemplar {

// Strokes are placed in integer arithmetic, so that every processor computes exactly the same ones.

/// Positions and distances in the picture are in units of 1/4096 pixel.
constexpr int k_pixel_bits = 12;
constexpr std::int32_t k_pixel = 1 << k_pixel_bits;
/// Unit vectors are 2^14 units long.
constexpr int k_unit_bits = 14;
constexpr std::int32_t k_unit = 1 << k_unit_bits;
/// Shares are in units of 1/1024.
constexpr int k_share_bits = 10;

struct FinePoint {
    std::int32_t x = 0, y = 0;
    bool operator==(const FinePoint&) const = default;
};
inline FinePoint operator+(FinePoint a, FinePoint b) {
    return {a.x + b.x, a.y + b.y};
}
inline FinePoint operator-(FinePoint a, FinePoint b) {
    return {a.x - b.x, a.y - b.y};
}

/// A unit vector, or zero for no direction.
struct Direction {
    std::int32_t x = 0, y = 0;
    explicit operator bool() const { return x != 0 || y != 0; }
    Direction operator-() const { return {-x, -y}; }
};
/// Cosine (dot) and sine (cross) of the angle from a to b, times k_unit^2.
inline std::int32_t dot(Direction a, Direction b) {
    return a.x * b.x + a.y * b.y;
}
inline std::int32_t cross(Direction a, Direction b) {
    return a.x * b.y - a.y * b.x;
}

/// Returns the square root of n < 2^31, rounded down. The float root is at most one off on every processor; the
/// correction is exact.
inline std::uint32_t floor_sqrt(std::uint32_t n) {
    auto root = static_cast<std::uint32_t>(std::sqrt(static_cast<float>(n)));
    if (root * root > n) --root;
    if ((root + 1) * (root + 1) <= n) ++root;
    return root;
}

/// Returns a / b rounded to nearest, halves away from zero; 0 < b.
inline std::int32_t rounded_quotient(std::int32_t a, std::uint32_t b) {
    const auto size = static_cast<std::uint32_t>(a < 0 ? -a : a);
    const auto quotient = static_cast<std::int32_t>((size + b / 2) / b);
    return a < 0 ? -quotient : quotient;
}

/// Returns the unit vector along a vector, or zero if it is zero; components within 2^15.
inline Direction direction_of(std::int32_t x, std::int32_t y) {
    const std::uint32_t length = floor_sqrt(static_cast<std::uint32_t>(x * x) + static_cast<std::uint32_t>(y * y));
    if (length == 0) return {};
    return {rounded_quotient(x * k_unit, length), rounded_quotient(y * k_unit, length)};
}

/// Returns a hash of a word; a bijection (the finalizer of MurmurHash3, Appleby, public domain).
inline std::uint32_t scatter(std::uint32_t word) {
    word = (word ^ (word >> 16)) * 0x85ebca6bU;
    word = (word ^ (word >> 13)) * 0xc2b2ae35U;
    return word ^ (word >> 16);
}

/// Returns the lowest `count` bits of a word in reverse order; 0 <= count <= 32, the others are zero.
inline std::uint32_t reversed_bits(std::uint32_t word, int count) {
    std::uint32_t reversed = 0;
    for (int i = 0; i < count; ++i) reversed |= (word >> i & 1U) << (count - 1 - i);
    return reversed;
}

}  // namespace exemplar
