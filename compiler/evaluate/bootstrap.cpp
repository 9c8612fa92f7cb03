#include "evaluate/bootstrap.hpp"

#include <algorithm>

#include "episodes/random.hpp"

namespace etlc::evaluate {

namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr double kLow = 0.025;
constexpr double kHigh = 0.975;

/// How many resamples of so many episodes are made at a time. With more than one there is less to
/// read, and more than eight are needed for sums that keep a processor busy.
std::size_t batch_of(std::size_t episodes) {
    constexpr std::size_t kMemory = std::size_t{8} << 20U;
    constexpr std::size_t kLeast = 8;
    return std::clamp<std::size_t>(kMemory / (episodes * sizeof(Weights::Weight)), kLeast,
                                   kResamples);
}

}  // namespace

Bootstrap::Bootstrap(std::size_t episodes) : whole_(episodes, 1, 1) {}

void Bootstrap::for_each_batch(const std::function<void(const Weights&)>& visit) const {
    const std::size_t episodes = whole_.episodes();
    if (episodes == 0) return;
    episodes::Random random(kSeed);
    const std::size_t batch = batch_of(episodes);
    for (std::size_t begin = 0; begin < kResamples; begin += batch) {
        Weights weights(episodes, std::min(batch, kResamples - begin), 0);
        for (std::size_t r = 0; r < weights.resamples(); ++r)
            for (std::size_t i = 0; i < episodes; ++i) ++weights[random.below(episodes)][r];
        visit(weights);
    }
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
    std::vector<double> there;
    for (const auto& value : values)
        if (value) there.push_back(*value);
    if (2 * there.size() < values.size() || there.empty()) return std::nullopt;
    std::sort(there.begin(), there.end());
    const auto quantile = [&](double share) {
        return there[static_cast<std::size_t>(share * static_cast<double>(there.size() - 1) + 0.5)];
    };
    return Interval{quantile(kLow), quantile(kHigh)};
}

}  // namespace etlc::evaluate
