#include "data/files/descriptor.hpp"

#include <unistd.h>

#include <utility>

namespace etlc::data {

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor() {
    if (number_ >= 0) ::close(number_);
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t n =
            uninterrupted([&] { return ::write(descriptor, bytes.data(), bytes.size()); });
        if (n == 0) errno = EIO;
        if (n <= 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(n));
    }
    return true;
}

bool read_all_at(int descriptor, std::uint64_t at, char* to, std::size_t n) {
    while (n > 0) {
        const ssize_t got =
            uninterrupted([&] { return ::pread(descriptor, to, n, static_cast<off_t>(at)); });
        if (got == 0) errno = EIO;
        if (got <= 0) return false;
        at += static_cast<std::uint64_t>(got);
        to += got;
        n -= static_cast<std::size_t>(got);
    }
    return true;
}

}  // namespace etlc::data
