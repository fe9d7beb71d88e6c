#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace couture {

/// Allocator that leaves numbers uninitialised, so that the threads that fill an array are the
/// first to touch its pages.
template <typename T>
struct UninitializedAllocator : std::allocator<T> {
    template <typename U>
    struct rebind {
        using other = UninitializedAllocator<U>;
    };
    template <typename U, typename... Args>
    void construct(U* p, Args&&... args) {
        if constexpr (sizeof...(Args) == 0) {
            ::new (static_cast<void*>(p)) U;
        } else {
            ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
        }
    }
};

/// A vector whose resize does not clear the new elements.
template <typename T>
using Buffer = std::vector<T, UninitializedAllocator<T>>;

}  // namespace couture
