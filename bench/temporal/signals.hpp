// Robustness values as a robot produces them: what every row of the tables is fed with.
// Takes: a length. Gives: three signals. Keeps true: the same numbers in every run.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

namespace bench {

struct Signals {
    std::vector<float> p, q, r;
    std::size_t size() const { return p.size(); }
};

/// Robustness as a distance to a target wanders: a random walk that is drawn back.
inline std::vector<float> walk(std::size_t length, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> step;
    std::vector<float> samples(length);
    float x = 0;
    for (float& sample : samples) sample = x = 0.99f * x + step(random);
    return samples;
}

/// Falls for twice as long as the longest window, then jumps: a queue of candidates fills up and
/// empties in one step.
inline std::vector<float> saw(std::size_t length, std::size_t period) {
    std::vector<float> samples(length);
    for (std::size_t i = 0; i < length; ++i) samples[i] = -static_cast<float>(i % period);
    return samples;
}

inline Signals walks(std::size_t length) {
    return {walk(length, 1), walk(length, 2), walk(length, 3)};
}

inline Signals saws(std::size_t window) {
    const std::size_t length = 4 * window;
    return {saw(length, 2 * window), saw(length, 2 * window - 1), saw(length, window + 1)};
}

}  // namespace bench
