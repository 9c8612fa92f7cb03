// Declarations for fuzz targets, and their checks.
// Takes: bytes from libFuzzer or from replay.cpp. Gives: nothing; a failed check stops the program,
// which is a finding.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace etlc::fuzz {

inline std::string_view text(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// A file in memory, for readers that take a path.
class File {
public:
    explicit File(std::string_view bytes) : number_(::memfd_create("fuzz", MFD_CLOEXEC)) {
        if (::write(number_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
            std::abort();
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() { ::close(number_); }

    std::string path() const { return "/proc/self/fd/" + std::to_string(number_); }

private:
    int number_;
};

/// Checks in every kind of build, unlike assert.
inline void require(bool promise, const char* words) {
    if (promise) return;
    std::fprintf(stderr, "broken promise: %s\n", words);
    std::abort();
}

/// Checks that a message is not empty, and safe for a terminal.
inline void require_printable(std::string_view message) {
    require(!message.empty() && message.size() < 4096, "a message has a sensible length");
    for (const char c : message)
        require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "a message is printable");
}

}  // namespace etlc::fuzz
