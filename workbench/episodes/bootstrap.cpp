#include "episodes/bootstrap.hpp"

#include <algorithm>

#include "episodes/random.hpp"

namespace etlc::episodes {

namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr double kLow = 0.025;
constexpr double kHigh = 0.975;

/// Computes x % n for a fixed n without a division, with the result of Random::below.
class Remainder {
public:
    explicit Remainder(std::uint64_t n) : n_(n), inverse_(UINT64_MAX / n) {}

    std::uint64_t of(std::uint64_t x) const {
        __extension__ using Wide = unsigned __int128;
        const auto quotient = static_cast<std::uint64_t>(Wide{x} * inverse_ >> 64U);  // or less
        std::uint64_t rest = x - quotient * n_;
        while (rest >= n_) rest -= n_;
        return rest;
    }

private:
    std::uint64_t n_;
    std::uint64_t inverse_;
};

/// Returns the number of resamples in a batch. Larger batches read frames less often; eight are
/// enough to keep a processor busy with sums.
std::size_t batch_of(std::size_t episodes) {
    constexpr std::size_t kMemory = std::size_t{4} << 20U;
    constexpr std::size_t kLeast = 8;
    return std::clamp<std::size_t>(kMemory / (episodes * sizeof(Weights::Weight)), kLeast,
                                   kResamples);
}

/// Draws the next resamples, one after the other: the draws of each are spread over all episodes.
Weights draw(Random& random, std::size_t episodes, std::size_t resamples) {
    const Remainder remainder(episodes);
    std::vector<Weights::Weight> by_resample(episodes * resamples);
    for (std::size_t r = 0; r < resamples; ++r) {
        Weights::Weight* const drawn = by_resample.data() + r * episodes;
        for (std::size_t i = 0; i < episodes; ++i) ++drawn[remainder.of(random.next())];
    }
    Weights weights(episodes, resamples, 0);
    for (std::size_t e = 0; e < episodes; ++e)
        for (std::size_t r = 0; r < resamples; ++r) weights[e][r] = by_resample[r * episodes + e];
    return weights;
}

}  // namespace

Bootstrap::Bootstrap(std::size_t episodes) : whole_(episodes, 1, 1) {}

void Bootstrap::for_each_batch(const std::function<void(const Weights&)>& visit) const {
    const std::size_t episodes = whole_.episodes();
    if (episodes == 0) return;
    Random random(kSeed);
    const std::size_t batch = batch_of(episodes);
    for (std::size_t begin = 0; begin < kResamples; begin += batch)
        visit(draw(random, episodes, std::min(batch, kResamples - begin)));
}

Figure Bootstrap::figure(
    const std::function<std::vector<std::optional<double>>(const Weights&)>& statistic) const {
    Figure result{statistic(whole_)[0], {}};
    if (!result.value || whole_.episodes() < 2) return result;
    std::vector<std::optional<double>> values;
    values.reserve(kResamples);
    for_each_batch([&](const Weights& weights) {
        const auto some = statistic(weights);
        values.insert(values.end(), some.begin(), some.end());
    });
    result.interval = percentile_interval(values);
    return result;
}

std::optional<Interval> percentile_interval(const std::vector<std::optional<double>>& values) {
    std::vector<double> defined;
    for (const auto& value : values)
        if (value) defined.push_back(*value);
    if (2 * defined.size() < values.size() || defined.empty()) return std::nullopt;
    std::sort(defined.begin(), defined.end());
    const auto quantile = [&](double share) {
        const double last = static_cast<double>(defined.size() - 1);
        return defined[static_cast<std::size_t>(share * last + 0.5)];
    };
    return Interval{quantile(kLow), quantile(kHigh)};
}

std::vector<std::optional<double>> shares(const std::vector<Fraction>& episodes,
                                          const Weights& weights) {
    std::vector<std::int64_t> parts(weights.resamples());
    std::vector<std::uint64_t> wholes(weights.resamples());
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        const auto [part, whole] = episodes[e];
        if (whole == 0) continue;
        for (std::size_t r = 0; r < parts.size(); ++r) {
            parts[r] += part * weights[e][r];
            wholes[r] += whole * weights[e][r];
        }
    }
    std::vector<std::optional<double>> result(parts.size());
    for (std::size_t r = 0; r < parts.size(); ++r)
        if (wholes[r] > 0)
            result[r] = static_cast<double>(parts[r]) / static_cast<double>(wholes[r]);
    return result;
}

Figure share(const Bootstrap& bootstrap, const std::vector<Fraction>& episodes) {
    return bootstrap.figure([&](const Weights& weights) { return shares(episodes, weights); });
}

}  // namespace etlc::episodes
