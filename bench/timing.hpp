// Times several routines and compares them.
// Takes: routines that each go over the same number of steps. Gives: nanoseconds per step, and
// ratios. Keeps true: the routines run in turn, round after round, so that other work on the
// machine affects all of them; figures are medians over the rounds, and a ratio is the median of
// the rounds' ratios.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace bench {

struct Routine {
    std::string name;
    std::function<void()> pass;  ///< goes over `steps` steps once
    std::size_t steps = 0;
};

/// Nanoseconds per step, one figure per round.
struct Series {
    std::vector<double> rounds;
    double median() const;
    double spread() const;  ///< the distance between the quartiles, relative to the median
};

/// The amount of measurement: rounds, and the least duration of a routine in a round.
struct Effort {
    int rounds = 15;
    double seconds_each = 0.01;
};

std::vector<Series> measure(const std::vector<Routine>& routines, Effort effort);

/// Returns the median over the rounds of a / b.
double ratio(const Series& a, const Series& b);

/// Keeps a compiler from dropping or moving writes to memory.
inline void settle_memory() {
    asm volatile("" ::: "memory");
}

/// A monitor, or an operator of one, step by step. sample(i) prepares the sample of step i, which a
/// control loop has ready.
struct Stepped {
    std::function<void()> reset;
    std::function<void(std::size_t i)> sample;
    std::function<void()> step;
};

/// Returns the nanoseconds of the slowest of `steps` calls of step(), without the cost of reading
/// the clock. Each call is timed in several passes, which begin with reset(), and its fastest time
/// counts, so other work on the machine does not.
double worst_step(std::size_t steps, const Stepped& stepped);

}  // namespace bench
