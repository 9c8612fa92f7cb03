// File descriptors.
// Keeps true: a descriptor is closed with its object; interrupted calls are repeated; `errno` holds
// the reason of a failure.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace etlc::data {

class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept;
    Descriptor& operator=(Descriptor&& other) noexcept;
    ~Descriptor();

    int operator*() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }

private:
    int number_;
};

/// Repeats a system call until no signal interrupts it.
template <class Call>
auto uninterrupted(Call call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

/// Writes all of `bytes`; false where they cannot be written.
bool write_all(int descriptor, std::string_view bytes);

/// Reads `n` bytes at `at`; false where that fails, with EIO where the file is too short.
bool read_all_at(int descriptor, std::uint64_t at, char* to, std::size_t n);

}  // namespace etlc::data
