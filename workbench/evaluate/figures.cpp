#include "evaluate/figures.hpp"

#include <algorithm>

#include "episodes/random.hpp"

namespace etlc::evaluate {

namespace {

std::optional<double> share(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
}

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
Weights draw(episodes::Random& random, std::size_t episodes, std::size_t resamples) {
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

void Counts::add(Label said, Label is) {
    if (is == Label::unknown)
        ++unlabelled;
    else if (said == Label::unknown)
        ++(is == Label::yes ? unsaid_positives : unsaid_negatives);
    else if (said == Label::yes)
        ++(is == Label::yes ? true_positives : false_positives);
    else
        ++(is == Label::yes ? false_negatives : true_negatives);
}

void Counts::add(const Counts& other, std::uint64_t times) {
    for (const auto& [name, count] : kCounts) this->*count += times * other.*count;
}

Rates rates(const Counts& c) {
    const std::uint64_t hits = c.true_positives;
    Rates result{{share(2 * hits, hits + c.false_positives + c.positives()),
                  share(hits, hits + c.false_positives), share(hits, c.positives()),
                  share(hits + c.true_negatives, c.total())},
                 {}};
    const auto always_true = share(2 * c.positives(), c.positives() + c.total());
    if (result.f1 && always_true) result.gain = *result.f1 - *always_true;
    return result;
}

std::vector<Rates> rates(const std::vector<Counts>& episodes, const Weights& weights) {
    std::vector<Rates> result(weights.resamples());
    std::vector<Counts> sums(weights.resamples());
    std::vector<std::uint64_t> sum(weights.resamples());
    for (const auto& [name, count] : kCounts) {
        std::fill(sum.begin(), sum.end(), 0);
        for (std::size_t e = 0; e < episodes.size(); ++e) {
            const std::uint64_t own = episodes[e].*count;
            if (own == 0) continue;
            for (std::size_t r = 0; r < sum.size(); ++r) sum[r] += own * weights[e][r];
        }
        for (std::size_t r = 0; r < sum.size(); ++r) sums[r].*count = sum[r];
    }
    for (std::size_t r = 0; r < sums.size(); ++r) result[r] = rates(sums[r]);
    return result;
}

Rates rates_of_constant(bool claim, std::uint64_t positives, std::uint64_t total) {
    Counts counts;
    (claim ? counts.true_positives : counts.false_negatives) = positives;
    (claim ? counts.false_positives : counts.true_negatives) = total - positives;
    return rates(counts);
}

Bootstrap::Bootstrap(std::size_t episodes) : whole_(episodes, 1, 1) {}

void Bootstrap::for_each_batch(const std::function<void(const Weights&)>& visit) const {
    const std::size_t episodes = whole_.episodes();
    if (episodes == 0) return;
    episodes::Random random(kSeed);
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

}  // namespace etlc::evaluate
