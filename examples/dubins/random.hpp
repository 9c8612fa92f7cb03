// Pseudo-random numbers that are the same on every machine.
// Takes: a seed. Gives: splitmix64 (Steele, Lea, Flood 2014) and uniform numbers made from it.
// Keeps true: it uses no std distribution, since those differ between standard libraries.
#pragma once

#include <cstdint>

namespace demo {

class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits() {
        state_ += 0x9e3779b97f4a7c15U;
        std::uint64_t x = state_;
        x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
        x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
        return x ^ (x >> 31U);
    }

    /// Returns a number uniform in [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits() >> 11U) * 0x1p-53);
    }

private:
    std::uint64_t state_;
};

}  // namespace demo
