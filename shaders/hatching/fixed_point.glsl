// Integer arithmetic for positions and directions (host/hatching/placement/fixed_point.h): results are the same on
// every device. This file and those that include it select between values instead of branching: D2 and D9 in
// docs/portability.md.
#ifndef EXEMPLAR_FIXED_POINT_GLSL
#define EXEMPLAR_FIXED_POINT_GLSL
#include "shaders/shared/hatching.h"

int dot_of(ivec2 a, ivec2 b) {
    return a.x * b.x + a.y * b.y;
}
int cross_of(ivec2 a, ivec2 b) {
    return a.x * b.y - a.y * b.x;
}

// The float root is at most one off on every device; the correction is exact.
uint floor_sqrt(uint n) {
    uint root = uint(sqrt(float(n)));
    root -= uint(root * root > n);
    return root + uint((root + 1u) * (root + 1u) <= n);
}

// Return a / b if it is below 2^20. Devices have no instruction for a division of integers. That of floats is at most
// one off here; the correction is exact.
uint quotient(uint a, uint b) {
    uint result = uint(float(a) * (1.0 / float(b)));
    result -= uint(result * b > a);
    return result + uint((result + 1u) * b <= a);
}
uvec2 quotient(uvec2 a, uint b) {
    uvec2 result = uvec2(vec2(a) * (1.0 / float(b)));
    result -= uvec2(greaterThan(result * b, a));
    return result + uvec2(lessThanEqual((result + 1u) * b, a));
}

// Returns a / b rounded to nearest, halves away from zero.
ivec2 rounded_quotient(ivec2 a, uint b) {
    return sign(a) * ivec2(quotient(uvec2(abs(a)) + b / 2u, b));
}

// Returns the unit vector along a vector, times k_unit; zero for a zero vector.
ivec2 direction_of(ivec2 way) {
    const uint size = floor_sqrt(uint(way.x * way.x) + uint(way.y * way.y));
    return rounded_quotient(way * k_unit, max(size, 1u));
}

ivec2 moved(ivec2 from, ivec2 way, int size) {
    return from + ((way * size + k_unit / 2) >> k_unit_bits);
}

// The finalizer of MurmurHash3 (Appleby, public domain).
uint scatter(uint word) {
    word = (word ^ (word >> 16)) * 0x85ebca6bu;
    word = (word ^ (word >> 13)) * 0xc2b2ae35u;
    return word ^ (word >> 16);
}

#endif
