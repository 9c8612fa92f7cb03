// Intervals by resampling episodes: frames of one episode are not independent, episodes are.
// Takes: the number of episodes, and a statistic of how often each counts. Gives: the 2.5 %
// and 97.5 % quantiles over kResamples draws with replacement (Efron's percentile interval). Keeps
// true: the draws come from a fixed seed, so that the same data give the same interval, on every
// machine and with any number of threads; memory is that of as many draws as fit 8 MB.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "episodes/ranking/auroc.hpp"

namespace etlc::evaluate {

inline constexpr std::uint32_t kResamples = 1000;

struct Interval {
    double low = 0;
    double high = 0;
};

/// A figure, where there is one, and its interval, where most resamples have the figure too.
struct Figure {
    std::optional<double> value;
    std::optional<Interval> interval;
};

using episodes::Weights;

class Bootstrap {
public:
    explicit Bootstrap(std::size_t episodes);

    /// Calls `visit` with all resamples, always the same ones in the same order, some at a time.
    void for_each_batch(const std::function<void(const Weights&)>& visit) const;
    /// One in which every episode counts once.
    const Weights& whole() const { return whole_; }

    /// `statistic(weights)`: of each of their resamples, in order.
    Figure figure(
        const std::function<std::vector<std::optional<double>>(const Weights&)>& statistic) const;

private:
    Weights whole_;
};

/// Of the values that are there, which need not be sorted.
std::optional<Interval> percentile_interval(const std::vector<std::optional<double>>& values);

}  // namespace etlc::evaluate
