#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace exemplar {

/// Eight floats in one of the compiler's vector types. Operators work lane by lane; `mask ? a : b` selects. Results
/// have the same bits on every instruction set; with AVX an operation is one instruction.
using EightFloats [[gnu::vector_size(32)]] = float;
using EightBits [[gnu::vector_size(32)]] = std::int32_t;  ///< result of a comparison: all bits of a lane are set, or
                                                          ///< none
using FourFloats [[gnu::vector_size(16)]] = float;
using TwoFloats [[gnu::vector_size(8)]] = float;

inline EightFloats eight_of(float value) {
    return EightFloats{} + value;
}

inline EightFloats square_root(EightFloats x) {
#ifdef __AVX__
    return _mm256_sqrt_ps(x);
#else
    for (int i = 0; i < 8; ++i) x[i] = std::sqrt(x[i]);
    return x;
#endif
}

/// Converts eight consecutive signed bytes to floats.
inline EightFloats eight_from_bytes(const std::int8_t* bytes) {
#ifdef __AVX2__
    return _mm256_cvtepi32_ps(_mm256_cvtepi8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes))));
#else
    EightFloats values;
    for (int i = 0; i < 8; ++i) values[i] = static_cast<float>(bytes[i]);
    return values;
#endif
}

inline EightFloats magnitude(EightFloats x) {
    return reinterpret_cast<EightFloats>(reinterpret_cast<EightBits>(x) & 0x7FFFFFFF);
}

/// Loads three consecutive floats; the fourth lane is zero.
inline FourFloats load_three(const float* numbers) {
#ifdef __AVX__
    return _mm_maskload_ps(numbers, _mm_setr_epi32(-1, -1, -1, 0));
#else
    TwoFloats two;
    std::memcpy(&two, numbers, sizeof(two));
    return __builtin_shufflevector(two, TwoFloats{numbers[2], 0}, 0, 1, 2, 3);
#endif
}

inline EightFloats joined(FourFloats low, FourFloats high) {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline FourFloats low_half(EightFloats a) {
    return __builtin_shufflevector(a, a, 0, 1, 2, 3);
}
inline FourFloats high_half(EightFloats a) {
    return __builtin_shufflevector(a, a, 4, 5, 6, 7);
}

struct FourEights {
    EightFloats a, b, c, d;
};
/// Transposes four values of eight items. The input has one vector per value, with a lane per item; the output has
/// the four values of items 0 and 4, of 1 and 5, of 2 and 6, and of 3 and 7. The function is its own inverse.
inline FourEights transposed(const FourEights& m) {
    const EightFloats ab = __builtin_shufflevector(m.a, m.b, 0, 8, 1, 9, 4, 12, 5, 13),
                      cd = __builtin_shufflevector(m.c, m.d, 0, 8, 1, 9, 4, 12, 5, 13),
                      ab_end = __builtin_shufflevector(m.a, m.b, 2, 10, 3, 11, 6, 14, 7, 15),
                      cd_end = __builtin_shufflevector(m.c, m.d, 2, 10, 3, 11, 6, 14, 7, 15);
    return {__builtin_shufflevector(ab, cd, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(ab, cd, 2, 3, 10, 11, 6, 7, 14, 15),
            __builtin_shufflevector(ab_end, cd_end, 0, 1, 8, 9, 4, 5, 12, 13),
            __builtin_shufflevector(ab_end, cd_end, 2, 3, 10, 11, 6, 7, 14, 15)};
}

}  // namespace exemplar
