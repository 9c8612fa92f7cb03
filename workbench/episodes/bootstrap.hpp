// Figures over episodes with confidence intervals from resampled episodes, for evaluation and
// calibration.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "episodes/folds.hpp"
#include "episodes/ranking/auroc.hpp"

namespace etlc::episodes {

// ---- random numbers -----------------------------------------------------------------------------
// Random numbers that are the same on every machine, unlike the distributions of the standard
// library. Source: splitmix64; Steele, Lea, Flood, "Fast Splittable Pseudorandom Number
// Generators", 2014.

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

// ---- figures ------------------------------------------------------------------------------------

inline constexpr std::uint32_t kResamples = 1000;

/// Efron's percentile intervals: the 2.5 % and 97.5 % quantiles over kResamples draws with
/// replacement, of episodes, since frames of one episode are not independent, or of groups of them.
/// The seed is fixed, so the same data give the same interval on every machine and with any number
/// of threads. Resamples that fit into memory at once are drawn once for all figures.
class Bootstrap {
public:
    /// `jobs`: threads that compute a figure; 0: one per core.
    explicit Bootstrap(std::size_t episodes, unsigned jobs = 1);
    /// Draws groups, with all of their episodes.
    explicit Bootstrap(const Groups& groups, unsigned jobs = 1);

    /// Calls `visit` with all resamples in batches: always the same ones, in the same order.
    void for_each_batch(const std::function<void(const Weights&)>& visit) const;
    /// Returns weights that count every episode once.
    const Weights& whole() const { return whole_; }
    /// Returns the number of groups, which without names are episodes.
    std::size_t groups() const { return groups_; }

    /// Computes a figure, with an interval if most resamples define it. `statistic(weights)`
    /// returns its value for each resample, in order. It is called once for `whole()`, and then by
    /// several threads at a time.
    Figure figure(
        const std::function<std::vector<std::optional<double>>(const Weights&)>& statistic) const;

private:
    using Batches = std::vector<Weights>;
    /// Calls `visit` with batches of which as many as fit into memory are drawn together.
    void for_each_round(const std::function<void(const Batches&)>& visit) const;

    Weights whole_;
    std::vector<std::uint32_t> group_of_;  ///< per episode; empty: each is drawn by itself
    std::size_t groups_;
    unsigned jobs_;
    mutable Batches drawn_;  ///< all resamples, if they fit into memory
};

/// Returns the interval of the defined values, which need not be sorted.
std::optional<Interval> percentile_interval(const std::vector<std::optional<double>>& values);

/// An episode's contribution to the numerator and the denominator of a share.
struct Fraction {
    std::int64_t part = 0;
    std::uint64_t whole = 0;
};

/// Returns the share in each resample, or nothing where the denominator is zero.
std::vector<std::optional<double>> shares(const std::vector<Fraction>& episodes,
                                          const Weights& weights);

Figure share(const Bootstrap& bootstrap, const std::vector<Fraction>& episodes);

}  // namespace etlc::episodes
