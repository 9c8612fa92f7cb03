// Arrays that begin at a multiple of 64 bytes, like the target sets of a generated header.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace bench {

template <class T>
struct AlignedAllocator {
    using value_type = T;
    static constexpr std::align_val_t kAlignment{64};

    AlignedAllocator() = default;
    template <class Other>
    AlignedAllocator(const AlignedAllocator<Other>&) {}
    T* allocate(std::size_t n) {
        return static_cast<T*>(::operator new(n * sizeof(T), kAlignment));
    }
    void deallocate(T* p, std::size_t) { ::operator delete(p, kAlignment); }
    template <class Other>
    bool operator==(const AlignedAllocator<Other>&) const {
        return true;
    }
    template <class Other>
    bool operator!=(const AlignedAllocator<Other>&) const {
        return false;
    }
};
template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

}  // namespace bench
