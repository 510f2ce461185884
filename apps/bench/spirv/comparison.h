#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "gpu/runtime/kernels/scalars.h"

namespace exemplar {

/// How far the contents of two buffers are apart.
struct BufferComparison {
    double largest = 0;         ///< largest difference of two numbers
    std::size_t differing = 0;  ///< numbers that differ by more than the tolerance
    std::size_t numbers = 0;    ///< compared ones
    std::string place;          ///< of the largest difference: "element 12.position[1]"
    std::string actual, expected;

    bool fits() const { return differing == 0; }
};

/// Compares a buffer's numbers with those expected, of equal size. The difference of two floats is divided by the
/// larger of 1 and the expected one's absolute value; that of integers is not. A NaN differs infinitely from all but a
/// NaN. Bytes between the numbers are not compared. Blocks whose numbers are not all known are compared as words of
/// four bytes, which must be equal.
BufferComparison compare_buffers(std::span<const std::byte> actual, std::span<const std::byte> expected,
                                 const BlockScalars& scalars, double tolerance);

}  // namespace exemplar
