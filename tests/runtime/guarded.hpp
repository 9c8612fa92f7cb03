// Memory that ends at an inaccessible page: a kernel that reads past its rows crashes.
// Takes: elements. Gives: a copy whose last byte is just before a page without access. Keeps true:
// this finds vector loads past the end in every build, at full speed; a sanitizer finds them only
// in code compiled with it.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace kernel_cases {

class Guarded {
public:
    Guarded() = default;
    Guarded(const Guarded&) = delete;
    Guarded& operator=(const Guarded&) = delete;
    ~Guarded() { release(); }

    /// Returns a copy of n elements, valid until the next call.
    template <class T>
    const T* copy(const T* from, std::size_t n) {
        const std::size_t bytes = n * sizeof(T);
        if (bytes > room_) reserve(bytes);
        unsigned char* to = end_ - bytes;
        if (bytes > 0) std::memcpy(to, from, bytes);
        return reinterpret_cast<const T*>(to);
    }

private:
    void reserve(std::size_t bytes) {
        release();
        const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
        room_ = (bytes / page + 1) * page;
        void* begin = ::mmap(nullptr, room_ + page, PROT_READ | PROT_WRITE,
                             MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (begin == MAP_FAILED) std::abort();
        end_ = static_cast<unsigned char*>(begin) + room_;
        if (::mprotect(end_, page, PROT_NONE) != 0) std::abort();
        mapped_ = room_ + page;
    }
    void release() {
        if (mapped_ > 0) ::munmap(end_ - room_, mapped_);
    }

    unsigned char* end_ = nullptr;
    std::size_t room_ = 0;    ///< bytes before `end_`
    std::size_t mapped_ = 0;  ///< with the page after it
};

}  // namespace kernel_cases
