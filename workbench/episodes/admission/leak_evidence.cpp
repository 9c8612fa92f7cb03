#include "episodes/admission/leak_evidence.hpp"

#include <cmath>
#include <cstdint>

namespace etlc::episodes {

namespace {

/// The probability of n or more of the frames, each by the mean of their chances. That is no less
/// than by the chance of each, where n is above what is expected (Hoeffding, "On the Distribution
/// of the Number of Successes in Independent Trials", 1956).
double at_least(std::uint64_t n, const NearRows::Around& around) {
    const auto frames = static_cast<double>(around.frames);
    const auto count = static_cast<double>(n);
    const double chance = around.chance / frames;
    if (around.chance >= count) return 1;
    if (chance <= 0) return 0;
    double log = (frames - count) * std::log1p(-chance);
    for (double k = 1; k <= count; ++k) log += std::log((frames - count + k) / k * chance);
    double term = std::exp(log);
    double sum = 0;
    for (double k = count; k <= frames && term > sum * 1e-9; ++k) {
        sum += term;
        term *= (frames - k) / (k + 1) * chance / (1 - chance);
    }
    return sum;
}

/// What all episodes say of one set.
struct Sum {
    std::uint64_t leaks = 0;  ///< episodes with a frame within rounding
    NearRows::Around close;
    NearRows::Around wide;
};

/// Far around the rows frames are too few for so many to be within rounding, and close to them they
/// do not merely crowd.
bool is_no_chance(const Sum& sum) {
    constexpr double kNotByChance = 0.001;
    constexpr double kNotByCrowding = 0.3;
    return sum.leaks > 0 && at_least(sum.leaks, sum.wide) < kNotByChance &&
           at_least(sum.leaks, sum.close) < kNotByCrowding;
}

}  // namespace

LeakEvidence::LeakEvidence(const Identities& episodes) {
    std::vector<Sum> sums;
    episodes.for_each([&](std::size_t, const Recorded& episode) {
        if (episode.near.size() > sums.size()) sums.resize(episode.near.size());
        for (std::size_t i = 0; i < episode.near.size(); ++i) {
            sums[i].leaks += episode.near[i].first ? 1 : 0;
            sums[i].close.add(episode.near[i].close);
            sums[i].wide.add(episode.near[i].wide);
        }
    });
    for (const Sum& sum : sums) leaks_.push_back(is_no_chance(sum));
}

std::optional<Leak> LeakEvidence::of(const Recorded& episode) const {
    if (episode.leak) return episode.leak;
    for (std::size_t i = 0; i < episode.near.size(); ++i)
        if (leaks_[i] && episode.near[i].first) return episode.near[i].first;
    return std::nullopt;
}

}  // namespace etlc::episodes
