// Whole numbers for positions and directions (host/hatching/fixed_point.h): results are the same on every device.
#ifndef EXEMPLAR_FIXED_POINT_GLSL
#define EXEMPLAR_FIXED_POINT_GLSL
#include "shaders/shared/hatching.h"

int dot_of(ivec2 a, ivec2 b) {
    return a.x * b.x + a.y * b.y;
}
int cross_of(ivec2 a, ivec2 b) {
    return a.x * b.y - a.y * b.x;
}

// The root of a float is near on every device; the rest is exact.
uint floor_sqrt(uint n) {
    uint root = uint(sqrt(float(n)));
    if (root * root > n) --root;
    if ((root + 1u) * (root + 1u) <= n) ++root;
    return root;
}

// a / b rounded to nearest, halves away from zero.
int rounded_quotient(int a, uint b) {
    const int quotient = int((uint(abs(a)) + b / 2u) / b);
    return a < 0 ? -quotient : quotient;
}

// The unit vector along a vector, times k_unit; zero for none.
ivec2 direction_of(ivec2 way) {
    const uint size = floor_sqrt(uint(way.x * way.x) + uint(way.y * way.y));
    if (size == 0u) return ivec2(0);
    return ivec2(rounded_quotient(way.x * k_unit, size), rounded_quotient(way.y * k_unit, size));
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
