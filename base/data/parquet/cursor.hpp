// Bytes, read from the front.
// Takes: a view of bytes. Gives: little-endian numbers and parts of it. Keeps true: what is not
// there is refused, with a word for what should be.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "data/parquet/refused.hpp"

namespace etlc::data::parquet {

class Cursor {
public:
    explicit Cursor(std::string_view bytes = {}) : bytes_(bytes) {}

    std::string_view rest() const { return bytes_; }
    bool at_end() const { return bytes_.empty(); }

    std::string_view take(std::uint64_t n, const char* what) {
        if (n > bytes_.size())
            refuse(std::string("ends in ") + what + ": " + std::to_string(n) + " bytes expected, " +
                   std::to_string(bytes_.size()) + " are there");
        const std::string_view part = bytes_.substr(0, n);
        bytes_.remove_prefix(n);
        return part;
    }

    std::uint8_t byte(const char* what) { return static_cast<std::uint8_t>(take(1, what)[0]); }

    /// The machine's order is that of the file; CMake builds for no other.
    template <class T>
    T number(const char* what) {
        T value;
        std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
        return value;
    }

    /// Seven bits a byte, the lowest first.
    std::uint64_t varint(const char* what) {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const std::uint8_t part = byte(what);
            value |= std::uint64_t{part & 0x7fU} << shift;
            if (part < 0x80) return value;
        }
        refuse(std::string("has a number of more than 64 bits in ") + what);
    }

private:
    std::string_view bytes_;
};

}  // namespace etlc::data::parquet
