#include "iga/core/buffer.h"

#include <sys/mman.h>

namespace couture {

namespace {

constexpr std::size_t large_page = std::size_t{1} << 21;
constexpr std::size_t large = 4 * large_page;

constexpr std::align_val_t alignment_of(std::size_t n_bytes) {
    return std::align_val_t{n_bytes >= large ? large_page : 64};
}

}  // namespace

void* allocate_aligned(std::size_t n_bytes) {
    void* memory = ::operator new(n_bytes, alignment_of(n_bytes));
    if (n_bytes >= large) {
        // A wish: where it is not granted, pages are small.
        static_cast<void>(madvise(memory, n_bytes, MADV_HUGEPAGE));
    }
    return memory;
}

void deallocate_aligned(void* memory, std::size_t n_bytes) noexcept {
    ::operator delete(memory, alignment_of(n_bytes));
}

}  // namespace couture
