#include "evaluate/figures.hpp"

#include <algorithm>

namespace etlc::evaluate {

namespace {

std::optional<double> share(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
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

}  // namespace etlc::evaluate
