// Episodes that every board can make itself: the same samples to the bit, from integers.
// Takes: a seed. Gives: floats that are multiples of 1/64, bits of float16, int8; and the decision
// to drop a sample.
#pragma once

#include <stddef.h>
#include <stdint.h>

class Recording {
public:
    explicit Recording(uint32_t seed) noexcept : state_(seed * 2654435761u + 1) {}

    /// Returns a number uniform in 0 to n - 1.
    uint32_t below(uint32_t n) noexcept {
        state_ = state_ * 1664525u + 1013904223u;
        return static_cast<uint32_t>((static_cast<uint64_t>(state_ >> 8) * n) >> 24);
    }
    bool once_in(uint32_t n) noexcept { return below(n) == 0; }
    /// Returns a number in [-1, 1).
    float noise() noexcept {
        return static_cast<float>(static_cast<int32_t>(below(128)) - 64) / 64.0f;
    }

    /// Returns `mean` plus noise in every element; occasionally one of them is not a number.
    void fill(float* z, size_t n, float mean, float spread) noexcept {
        for (size_t i = 0; i < n; ++i) z[i] = mean + spread * noise();
        if (once_in(23)) z[below(static_cast<uint32_t>(n))] = __builtin_nanf("");
    }
    /// Returns float16 in [1, 4), as bits.
    void fill(uint16_t* z, size_t n) noexcept {
        for (size_t i = 0; i < n; ++i) z[i] = static_cast<uint16_t>(0x3c00u + below(0x800u));
        if (once_in(23)) z[0] = 0x7c00;  // infinite
    }
    void fill(int8_t* z, size_t n, int amplitude) noexcept {
        for (size_t i = 0; i < n; ++i) {
            z[i] = static_cast<int8_t>(
                static_cast<int>(below(static_cast<uint32_t>(2 * amplitude))) - amplitude);
        }
    }

private:
    uint32_t state_;
};
