#include "tests/fuzz/allocation.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace exemplar::fuzz {
namespace {

std::atomic<std::size_t> live{0}, peak{0};

}  // namespace

std::size_t live_bytes() {
    return live;
}
std::size_t peak_bytes() {
    return peak;
}
void reset_peak() {
    peak = live.load();
}

#ifndef __SANITIZE_ADDRESS__
namespace {

void* counted(void* memory) {
    if (!memory) throw std::bad_alloc();
    live += malloc_usable_size(memory);
    peak = std::max(peak.load(), live.load());
    return memory;
}
void uncounted(void* memory) {
    if (memory) live -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace
#endif

}  // namespace exemplar::fuzz

#ifndef __SANITIZE_ADDRESS__
void* operator new(std::size_t size) {
    return exemplar::fuzz::counted(std::malloc(size));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto step = static_cast<std::size_t>(alignment);
    return exemplar::fuzz::counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* memory) noexcept {
    exemplar::fuzz::uncounted(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    exemplar::fuzz::uncounted(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    exemplar::fuzz::uncounted(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    exemplar::fuzz::uncounted(memory);
}
#endif
