// Times of several routines that are compared with one another.
// Takes: routines that each go over the same number of steps. Gives: nanoseconds a step, and
// ratios. Keeps true: the routines run in turn, round after round, so that what the machine does
// meanwhile hits all of them; figures are medians over the rounds, and a ratio is the median of the
// rounds' ratios.
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

/// Nanoseconds a step, a figure a round.
struct Series {
    std::vector<double> rounds;
    double median() const;
    double spread() const;  ///< the distance between the quartiles, as a share of the median
};

/// How long to measure: rounds, and the least duration of a routine in a round.
struct Effort {
    int rounds = 15;
    double seconds_each = 0.01;
};

std::vector<Series> measure(const std::vector<Routine>& routines, Effort effort);

/// The median over the rounds of a / b.
double ratio(const Series& a, const Series& b);

/// Keeps a compiler from dropping or moving what is written to memory.
inline void settle_memory() {
    asm volatile("" ::: "memory");
}

/// A monitor, or an operator of one, step by step. sample(i) brings what step i takes, which a
/// control loop has at hand.
struct Stepped {
    std::function<void()> reset;
    std::function<void(std::size_t i)> sample;
    std::function<void()> step;
};

/// The slowest of `steps` calls of step(), less the cost of reading the clock, in nanoseconds. Each
/// is timed in several passes, which begin with reset(), and its fastest time counts: so what the
/// machine does meanwhile does not.
double worst_step(std::size_t steps, const Stepped& stepped);

}  // namespace bench
