// Reads the bytes of a Parquet file from the front: little-endian numbers and parts.
// Keeps true: missing bytes are refused, with the name of what was expected.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "data/records/protocol.hpp"

namespace etlc::data::parquet {

/// Why a Parquet file is not read. Only etlc-read-parquet throws it, and sends the text to etlc.
class Refused : public std::runtime_error {
public:
    Refused(records::Cause cause, const std::string& why)
        : std::runtime_error(why), cause_(cause) {}
    records::Cause cause() const { return cause_; }

private:
    records::Cause cause_;
};

/// Refuses a file that contradicts itself.
[[noreturn]] inline void refuse(const std::string& why) {
    throw Refused(records::Cause::file, why);
}

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

    /// The byte order of the file is that of the machine.
    template <class T>
    T number(const char* what) {
        T value;
        std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
        return value;
    }

    /// Reads seven bits a byte, the lowest first.
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
