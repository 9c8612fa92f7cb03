// Random numbers for tests: the same seed gives the same numbers with every standard library.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace etlc::tests {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    /// Returns a number uniform in [low, high].
    int between(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }
    bool chance(double probability) { return uniform() < probability; }
    /// Returns a number uniform in [0, 1).
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }
    /// Returns a multiple of `grain` in [low, high].
    double grid(double low, double high, double grain) {
        return low + grain * between(0, static_cast<int>((high - low) / grain));
    }
    template <class T>
    const T& pick(const std::vector<T>& choices) {
        return choices[static_cast<std::size_t>(between(0, static_cast<int>(choices.size()) - 1))];
    }
    std::string word(const std::vector<std::string>& choices) { return pick(choices); }

private:
    std::mt19937_64 engine_;
};

}  // namespace etlc::tests
