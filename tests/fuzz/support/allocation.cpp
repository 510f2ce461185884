#include "tests/fuzz/support/allocation.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/support/sanitizer.h"
#ifdef EXEMPLAR_SANITIZED
#include <sanitizer/allocator_interface.h>
#include <sanitizer/asan_interface.h>
#endif

namespace exemplar::fuzz {
namespace {

std::atomic<std::size_t> live{0}, peak{0};

void add(std::size_t bytes) {
    live += bytes;
    peak = std::max(peak.load(), live.load());
}

#ifdef EXEMPLAR_SANITIZED
void on_allocation(const volatile void*, std::size_t bytes) {
    add(bytes);
}
/// What was allocated before the hooks were installed is freed uncounted.
void on_free(const volatile void* memory) {
    const std::size_t bytes = memory ? __sanitizer_get_allocated_size(memory) : 0;
    live -= std::min(bytes, live.load());
}
/// Has a variable that others could point to, so it takes a frame from AddressSanitizer.
[[gnu::noinline]] void take_frame() {
    std::array<char, 16> variable;
    asm volatile("" : : "r"(variable.data()) : "memory");
}
[[maybe_unused]] const int hooks = __sanitizer_install_malloc_and_free_hooks(on_allocation, on_free);
#else
void* counted(void* memory) {
    if (!memory) throw std::bad_alloc();
    add(malloc_usable_size(memory));
    return memory;
}
void uncounted(void* memory) {
    if (memory) live -= malloc_usable_size(memory);
    std::free(memory);
}
#endif

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

void free_unwound_frames() {
#ifdef EXEMPLAR_SANITIZED
    __asan_handle_no_return();  // as if to throw: the next frame to be taken frees those below it
    take_frame();
#endif
}

}  // namespace exemplar::fuzz

#ifndef EXEMPLAR_SANITIZED
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
