#pragma once

#include <cstddef>
#include <new>
#include <utility>
#include <vector>

namespace couture {

/// Memory aligned to cache lines; large pieces ask for large pages, whose first touch costs a
/// fraction of that of small ones.
///
/// @throws std::bad_alloc  if there is none
[[nodiscard]] void* allocate_aligned(std::size_t n_bytes);
void deallocate_aligned(void* memory, std::size_t n_bytes) noexcept;

/// Allocator that leaves numbers uninitialised, so that the threads that fill an array are the
/// first to touch its pages, and aligns to cache lines, so that it can be read as vectors.
template <typename T>
struct UninitializedAllocator {
    using value_type = T;

    UninitializedAllocator() = default;
    template <typename U>
    UninitializedAllocator(const UninitializedAllocator<U>&) noexcept {}

    [[nodiscard]] T* allocate(std::size_t n) {
        return static_cast<T*>(allocate_aligned(n * sizeof(T)));
    }
    void deallocate(T* p, std::size_t n) noexcept { deallocate_aligned(p, n * sizeof(T)); }

    template <typename U, typename... Args>
    void construct(U* p, Args&&... args) {
        if constexpr (sizeof...(Args) == 0) {
            ::new (static_cast<void*>(p)) U;
        } else {
            ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
        }
    }
    bool operator==(const UninitializedAllocator&) const { return true; }
};

/// A vector whose resize does not clear the new elements.
template <typename T>
using Buffer = std::vector<T, UninitializedAllocator<T>>;

}  // namespace couture
