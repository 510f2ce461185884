#pragma once

#include <cstddef>

namespace exemplar::fuzz {

/// Bytes that were allocated and not freed, and the most there were since reset_peak; with a sanitizer's allocator all
/// of them, without one those of `new`.
std::size_t live_bytes();
std::size_t peak_bytes();
void reset_peak();

}  // namespace exemplar::fuzz
