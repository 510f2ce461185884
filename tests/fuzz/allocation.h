#pragma once

#include <cstddef>

namespace exemplar::fuzz {

/// Bytes that `new` has handed out and not got back, and the most there were since reset_peak. Both stay 0 in a build
/// with sanitizers, which bring their own allocator.
std::size_t live_bytes();
std::size_t peak_bytes();
void reset_peak();

}  // namespace exemplar::fuzz
