// Robustness values like those of a robot, for every row of the tables.
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

/// Robustness with a wandering distance to a target: a mean-reverting random walk.
inline std::vector<float> walk(std::size_t length, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> step;
    std::vector<float> samples(length);
    float x = 0;
    for (float& sample : samples) sample = x = 0.99f * x + step(random);
    return samples;
}

/// Falls for twice the longest window, then jumps: a queue of candidates fills up and empties in
/// one step.
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
