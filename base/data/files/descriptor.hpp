// File descriptors.
// Keeps true: one is closed with its object; what a signal interrupts goes on; `errno` says why
// something failed.
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

/// `call`, of the system, until no signal interrupts it.
template <class Call>
auto uninterrupted(Call call) {
    auto result = call();
    while (result < 0 && errno == EINTR) result = call();
    return result;
}

/// All of `bytes`; false where it cannot be written.
bool write_all(int descriptor, std::string_view bytes);

/// `n` bytes from `at` on; false where they cannot be read or are not there, which is EIO.
bool read_all_at(int descriptor, std::uint64_t at, char* to, std::size_t n);

}  // namespace etlc::data
