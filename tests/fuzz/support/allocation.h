#pragma once

#include <cstddef>

namespace exemplar::fuzz {

/// Bytes that were allocated and not freed, and the most there were since reset_peak; with a sanitizer's allocator all
/// of them, without one those of `new`.
std::size_t live_bytes();
std::size_t peak_bytes();
void reset_peak();

/// With AddressSanitizer's detect_stack_use_after_return, the frames that an exception unwound stay taken, and many of
/// them make each call slow: frees those below the caller's. Does nothing without the sanitizer.
void free_unwound_frames();

}  // namespace exemplar::fuzz
