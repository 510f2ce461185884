#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "host/core/eight.h"
#ifdef __F16C__
#include <immintrin.h>
#endif

namespace exemplar {

/// An IEEE 754 binary16 number. Magnitudes from 6e-5 to 65504 have the full 11 significant bits.
struct Half {
    std::uint16_t bits = 0;
    bool operator==(const Half&) const = default;
};

/// Returns the nearest half; clamps to the largest finite half beyond its range.
inline Half to_half(float value) {
    constexpr float k_largest = 65504.0f;
    const float bounded = value > k_largest ? k_largest : value < -k_largest ? -k_largest : value;
    return {Eigen::half_impl::float_to_half_rtne(bounded).x};
}
inline float from_half(Half half) {
    return Eigen::half_impl::half_to_float(Eigen::half_impl::raw_uint16_to_half(half.bits));
}

/// Converts eight consecutive halves to floats.
inline EightFloats eight_from_halves(const Half* halves) {
#ifdef __F16C__
    return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(halves)));
#else
    EightFloats values;
    for (int i = 0; i < 8; ++i) values[i] = from_half(halves[i]);
    return values;
#endif
}

}  // namespace exemplar
