// Writes lines of text without a library.
// Takes: a name, numbers, floats, verdicts, bytes. Gives: one line to the board: the name, numbers
// in hexadecimal, for a verdict its status, lower bound, robustness and upper bound, floats as
// their bits.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "board.hpp"

class Line {
public:
    explicit Line(const char* name) noexcept {
        while (*name != 0) put(*name++);
    }
    void number(uint32_t x) noexcept {
        put(' ');
        for (int shift = 28; shift >= 0; shift -= 4) digit(x >> shift);
    }
    void bytes(const uint8_t* x, size_t size) noexcept {
        put(' ');
        for (size_t i = 0; i < size; ++i) digit(x[i] >> 4), digit(x[i]);
    }
    void figure(const float& x) noexcept { number(bits(x)); }
    template <class Verdict>
    void verdict(const Verdict& verdict) noexcept {
        number(verdict.status);
        number(bits(verdict.lower));
        number(bits(verdict.robustness));
        number(bits(verdict.upper));
    }
    void write() noexcept {
        put('\n');
        put(0);
        board_write(text_);
    }

private:
    void digit(uint32_t x) noexcept { put("0123456789abcdef"[x & 15]); }
    void put(char c) noexcept { text_[length_++] = c; }
    static uint32_t bits(const float& x) noexcept {
        uint32_t b = 0;
        __builtin_memcpy(&b, &x, sizeof b);
        return b;
    }
    char text_[160];
    uint32_t length_ = 0;
};
