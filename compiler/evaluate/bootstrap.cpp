#include "evaluate/bootstrap.hpp"

#include <algorithm>

#include "episodes/random.hpp"

namespace etlc::evaluate {

namespace {

constexpr std::uint64_t kSeed = 2026;
constexpr double kLow = 0.025;
constexpr double kHigh = 0.975;

}  // namespace

Bootstrap::Bootstrap(std::size_t episodes) : whole_(episodes, 1) {}

void Bootstrap::for_each_resample(const std::function<void(const Weights&)>& visit) const {
    if (whole_.empty()) return;
    episodes::Random random(kSeed);
    Weights weights;
    for (std::uint32_t resample = 0; resample < kResamples; ++resample) {
        weights.assign(whole_.size(), 0);
        for (std::size_t i = 0; i < whole_.size(); ++i) ++weights[random.below(whole_.size())];
        visit(weights);
    }
}

Figure Bootstrap::figure(
    const std::function<std::optional<double>(const Weights&)>& statistic) const {
    Figure result{statistic(whole_), {}};
    if (!result.value || whole_.size() < 2) return result;
    std::vector<std::optional<double>> values;
    values.reserve(kResamples);
    for_each_resample([&](const Weights& weights) { values.push_back(statistic(weights)); });
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
