// Allocates large blocks on huge pages. Features of a mesh take a hundred megabytes; with pages of 4 KiB, mapping
// them took a third of the time of labeling a mesh with cached features. Systems commonly give huge pages only to
// programs that ask for them, so the allocation functions below do.

#include <sys/mman.h>

#include <cstdlib>
#include <limits>
#include <new>

namespace {

constexpr std::size_t k_huge_page = std::size_t{2} << 20;
constexpr std::size_t k_least = 2 * k_huge_page;  // the end of a block may waste most of a page

void* allocate(std::size_t bytes) {
    if (bytes < k_least) return std::malloc(bytes > 0 ? bytes : 1);
    if (bytes > std::numeric_limits<std::size_t>::max() - k_huge_page) return nullptr;
    const std::size_t pages = (bytes + k_huge_page - 1) / k_huge_page;
    void* block = std::aligned_alloc(k_huge_page, pages * k_huge_page);
    if (block) madvise(block, pages * k_huge_page, MADV_HUGEPAGE);  // refused: small pages serve as well
    return block;
}

}  // namespace

// All other forms of new and delete, except those with an alignment, call these.
void* operator new(std::size_t bytes) {
    for (;;) {
        if (void* block = allocate(bytes)) return block;
        const std::new_handler handler = std::get_new_handler();
        if (!handler) throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* block) noexcept {
    std::free(block);
}

void operator delete(void* block, std::size_t) noexcept {
    std::free(block);
}
