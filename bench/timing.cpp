#include "timing.hpp"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace bench {

namespace {

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration time) {
    return std::chrono::duration<double, std::nano>(time).count();
}

/// Returns the processor time of this program so far, in nanoseconds, without that of other
/// programs.
double processor_time() {
    return static_cast<double>(std::clock()) * (1e9 / CLOCKS_PER_SEC);
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

/// Returns the number of passes that take at least `seconds` together.
int passes_for(const Routine& routine, double seconds) {
    for (int passes = 1;; passes *= 2) {
        const double start = processor_time();
        for (int i = 0; i < passes; ++i) routine.pass();
        const double took = (processor_time() - start) * 1e-9;
        if (took >= seconds) return passes;
        if (took > seconds / 64) return std::max(1, static_cast<int>(passes * seconds / took) + 1);
    }
}

}  // namespace

double Series::median() const {
    return quantile(rounds, 0.5);
}

double Series::spread() const {
    return (quantile(rounds, 0.75) - quantile(rounds, 0.25)) / median();
}

std::vector<Series> measure(const std::vector<Routine>& routines, Effort effort) {
    std::vector<int> passes;
    for (const Routine& routine : routines)
        passes.push_back(passes_for(routine, effort.seconds_each));
    std::vector<Series> series(routines.size());
    for (int round = 0; round < effort.rounds; ++round) {
        for (std::size_t r = 0; r < routines.size(); ++r) {
            const double start = processor_time();
            for (int i = 0; i < passes[r]; ++i) routines[r].pass();
            const double took = processor_time() - start;
            series[r].rounds.push_back(took / (static_cast<double>(routines[r].steps) * passes[r]));
        }
    }
    return series;
}

double ratio(const Series& a, const Series& b) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.rounds.size(); ++i) ratios.push_back(a.rounds[i] / b.rounds[i]);
    return quantile(ratios, 0.5);
}

double worst_step(std::size_t steps, const Stepped& stepped) {
    std::vector<double> fastest(steps, 1e9);
    double clock = 1e9;
    for (int pass = 0; pass < 25; ++pass) {
        stepped.reset();
        for (std::size_t i = 0; i < steps; ++i) {
            stepped.sample(i);
            settle_memory();
            const Clock::time_point start = Clock::now();
            stepped.step();
            settle_memory();
            const Clock::time_point end = Clock::now();
            fastest[i] = std::min(fastest[i], nanoseconds(end - start));
            clock = std::min(clock, nanoseconds(Clock::now() - end));
        }
    }
    return std::max(0.0, *std::max_element(fastest.begin(), fastest.end()) - clock);
}

}  // namespace bench
