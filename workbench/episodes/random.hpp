// Random numbers that are the same on every machine, unlike the distributions of the standard
// library. Source: splitmix64; Steele, Lea, Flood, "Fast Splittable Pseudorandom Number
// Generators", 2014.
#pragma once

#include <cstdint>

namespace etlc::episodes {

class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t x = state_;
        x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
        x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
        return x ^ (x >> 31U);
    }
    /// Returns 0 to n - 1, n below 2^32; the bias is below n / 2^64.
    std::uint64_t below(std::uint64_t n) { return next() % n; }
    /// Returns a number in [0, 1).
    double unit() { return static_cast<double>(next() >> 11U) * 0x1p-53; }

private:
    std::uint64_t state_;
};

}  // namespace etlc::episodes
