#include "episodes/bootstrap.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "episodes/parallel.hpp"

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

/// Returns the number of resamples that are drawn together. More read frames less often; eight are
/// enough to keep a processor busy with sums.
std::size_t round_of(std::size_t episodes) {
    constexpr std::size_t kMemory = std::size_t{4} << 20U;
    constexpr std::size_t kLeast = 8;
    return std::clamp<std::size_t>(kMemory / (episodes * sizeof(Weights::Weight)), kLeast,
                                   kResamples);
}

/// The units that are drawn: episodes, or groups of them.
struct Drawn {
    std::size_t episodes;
    std::size_t groups;
    const std::vector<std::uint32_t>& group_of;  ///< per episode; empty: each is one

    std::size_t group(std::size_t episode) const {
        return group_of.empty() ? episode : group_of[episode];
    }
};

/// Draws the next resamples, one after the other: the draws of each are spread over all groups.
Weights draw(Random& random, const Drawn& of, std::size_t resamples) {
    const Remainder remainder(of.groups);
    std::vector<Weights::Weight> by_resample(of.groups * resamples);
    for (std::size_t r = 0; r < resamples; ++r) {
        Weights::Weight* const drawn = by_resample.data() + r * of.groups;
        for (std::size_t i = 0; i < of.groups; ++i) ++drawn[remainder.of(random.next())];
    }
    Weights weights(of.episodes, resamples, 0);
    for (std::size_t e = 0; e < of.episodes; ++e)
        for (std::size_t r = 0; r < resamples; ++r)
            weights[e][r] = by_resample[r * of.groups + of.group(e)];
    return weights;
}

/// Draws the next resamples in a batch for each thread.
std::vector<Weights> draw_batches(Random& random, const Drawn& of, std::size_t resamples,
                                  std::size_t batches) {
    std::vector<Weights> drawn;
    const std::size_t batch = (resamples + batches - 1) / batches;
    for (std::size_t begin = 0; begin < resamples; begin += batch)
        drawn.push_back(draw(random, of, std::min(batch, resamples - begin)));
    return drawn;
}

std::vector<std::uint32_t> groups_of_each(const Groups& groups) {
    std::vector<std::uint32_t> result;
    for (std::size_t e = 0; e < groups.episodes() && groups.are_named(); ++e)
        result.push_back(groups.of(e));
    return result;
}

}  // namespace

Bootstrap::Bootstrap(std::size_t episodes, unsigned jobs)
    : whole_(episodes, 1, 1),
      groups_(episodes),
      jobs_(std::max(1U, jobs > 0 ? jobs : std::thread::hardware_concurrency())) {}

Bootstrap::Bootstrap(const Groups& groups, unsigned jobs) : Bootstrap(groups.episodes(), jobs) {
    group_of_ = groups_of_each(groups);
    groups_ = groups.count();
}

void Bootstrap::for_each_round(const std::function<void(const Batches&)>& visit) const {
    const std::size_t episodes = whole_.episodes();
    if (episodes == 0) return;
    Random random(kSeed);
    const Drawn of{episodes, groups_, group_of_};
    const std::size_t round = round_of(episodes);
    if (round == kResamples) {
        if (drawn_.empty()) drawn_ = draw_batches(random, of, round, jobs_);
        return visit(drawn_);
    }
    for (std::size_t begin = 0; begin < kResamples; begin += round)
        visit(draw_batches(random, of, std::min(round, kResamples - begin), jobs_));
}

void Bootstrap::for_each_batch(const std::function<void(const Weights&)>& visit) const {
    for_each_round([&](const Batches& batches) {
        for (const Weights& batch : batches) visit(batch);
    });
}

Figure Bootstrap::figure(
    const std::function<std::vector<std::optional<double>>(const Weights&)>& statistic) const {
    Figure result{statistic(whole_)[0], {}};
    if (!result.value || groups_ < 2) return result;
    std::vector<std::optional<double>> values;
    values.reserve(kResamples);
    for_each_round([&](const Batches& batches) {
        std::vector<std::vector<std::optional<double>>> some(batches.size());
        std::atomic<std::size_t> next = 0;
        const std::exception_ptr failure = in_threads(jobs_, batches.size(), [&] {
            for (std::size_t i = next++; i < batches.size(); i = next++)
                some[i] = statistic(batches[i]);
        });
        if (failure) std::rethrow_exception(failure);
        for (const auto& batch : some) values.insert(values.end(), batch.begin(), batch.end());
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
