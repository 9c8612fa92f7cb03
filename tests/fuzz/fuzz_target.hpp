// What a fuzz target defines, and how it says that something is wrong.
// Takes: bytes from libFuzzer or from replay.cpp. Gives: nothing; a broken promise stops the
// program, which is a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace etlc::fuzz {

inline std::string_view text(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Unlike assert, in every kind of build.
inline void require(bool promise, const char* words) {
    if (promise) return;
    std::fprintf(stderr, "broken promise: %s\n", words);
    std::abort();
}

/// A message says something, and only what a terminal may be sent.
inline void require_printable(std::string_view message) {
    require(!message.empty() && message.size() < 4096, "a message has a sensible length");
    for (const char c : message)
        require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "a message is printable");
}

}  // namespace etlc::fuzz
