// The mix of runs and packed bits in which Parquet writes levels and places in a dictionary.
// Takes: bytes and the bits of a number. Gives: the numbers, one after the other. Keeps true:
// memory does not grow with the length of a run. Source: apache/parquet-format, Encodings.md,
// "Run Length Encoding / Bit-Packing Hybrid".
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string_view>

#include "data/parquet/cursor.hpp"

namespace etlc::data::parquet {

class Runs {
public:
    Runs() = default;
    Runs(std::string_view bytes, unsigned bits, const char* what)
        : bytes_(bytes), bits_(bits), what_(what) {}

    std::uint32_t next() {
        while (left_ == 0) begin();
        --left_;
        return packed_.empty() ? value_ : unpack();
    }

    /// How many of the next `n` are 0, of numbers of one bit.
    std::uint64_t zeros(std::uint64_t n) {
        std::uint64_t found = 0;
        while (n > 0) {
            while (left_ == 0) begin();
            std::uint64_t part = std::min(n, left_);
            if (packed_.empty()) {
                found += value_ == 0 ? part : 0;
            } else if (part < 8 || bit_ % 8 != 0) {
                found += unpack() == 0 ? 1 : 0;
                part = 1;
            } else {
                part -= part % 8;
                for (const char byte : packed_.substr(bit_ / 8, part / 8))
                    found +=
                        8U - static_cast<unsigned>(std::popcount(static_cast<unsigned char>(byte)));
                bit_ += part;
            }
            left_ -= part;
            n -= part;
        }
        return found;
    }

private:
    void begin() {
        const std::uint64_t head = bytes_.varint(what_);
        if ((head & 1U) == 0) {
            left_ = head >> 1U;
            packed_ = {};
            value_ = 0;
            for (unsigned shift = 0; shift < bits_; shift += 8)
                value_ |= std::uint32_t{bytes_.byte(what_)} << shift;
            return;
        }
        // Eight numbers a group; some writers leave out the end of the last group.
        const std::uint64_t groups = head >> 1U;
        value_ = 0;
        if (bits_ == 0) {
            packed_ = {};
            left_ = 8 * groups;
            return;
        }
        const std::uint64_t most = 8 * bytes_.rest().size() / bits_;
        if (groups > 0 && most == 0) bytes_.take(bits_, what_);  // says that it ends
        left_ = groups <= most / 8 ? 8 * groups : most;
        packed_ = bytes_.take((left_ * bits_ + 7) / 8, what_);
        bit_ = 0;
    }

    std::uint32_t unpack() {
        std::uint64_t word = 0;
        const std::uint64_t first = bit_ / 8;
        for (std::uint64_t i = 0; i < 5 && first + i < packed_.size(); ++i)
            word |= std::uint64_t{static_cast<std::uint8_t>(packed_[first + i])} << (8 * i);
        const std::uint64_t value = (word >> (bit_ % 8)) & ((1ULL << bits_) - 1);
        bit_ += bits_;
        return static_cast<std::uint32_t>(value);
    }

    Cursor bytes_;
    unsigned bits_ = 0;
    const char* what_ = "";
    std::uint64_t left_ = 0;
    std::uint32_t value_ = 0;
    std::string_view packed_;
    std::uint64_t bit_ = 0;
};

}  // namespace etlc::data::parquet
