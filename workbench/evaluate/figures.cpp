#include "evaluate/figures.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace etlc::evaluate {

namespace {

std::optional<double> share(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void Counts::add(Label predicted, Label actual) {
    if (actual == Label::unknown)
        ++unlabelled;
    else if (predicted == Label::unknown)
        ++(actual == Label::yes ? unknown_positives : unknown_negatives);
    else if (predicted == Label::yes)
        ++(actual == Label::yes ? true_positives : false_positives);
    else
        ++(actual == Label::yes ? false_negatives : true_negatives);
}

void Counts::add(const Counts& other, std::uint64_t times) {
    for (const auto& [name, count] : kCounts) this->*count += times * other.*count;
}

std::optional<double> mean(std::optional<double> a, std::optional<double> b) {
    return a && b ? std::optional((*a + *b) / 2) : a ? a : b;
}

Rates rates(const Counts& c) {
    const std::uint64_t hits = c.true_positives;
    Rates result{{share(2 * hits, hits + c.false_positives + c.positives()),
                  share(hits, hits + c.false_positives), share(hits, c.positives()),
                  share(hits + c.true_negatives, c.total()), share(c.unknown(), c.total()),
                  share(c.wrong(), c.total() - c.unknown()),
                  share(c.false_negatives, c.positives()), share(c.false_positives, c.negatives())},
                 {},
                 {}};
    const auto always_true = share(2 * c.positives(), c.positives() + c.total());
    if (result.f1 && always_true) result.gain = *result.f1 - *always_true;
    result.decided = mean(result.recall, share(c.true_negatives, c.negatives()));
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

Rates rates_of_constant(bool prediction, std::uint64_t positives, std::uint64_t total) {
    Counts counts;
    (prediction ? counts.true_positives : counts.false_negatives) = positives;
    (prediction ? counts.false_positives : counts.true_negatives) = total - positives;
    return rates(counts);
}

// ---- the duration baseline ----------------------------------------------------------------------

namespace {

/// Predicts true for the numbers from the threshold on, or for those below it.
struct Rule {
    bool from = true;
    double threshold = 0;
};

constexpr Rule kAlwaysTrue{true, 0};
constexpr Rule kAlwaysFalse{false, 0};

/// The quality of a rule, compared lexicographically.
struct Merit {
    double f1 = 0;
    std::uint64_t agreeing = 0;

    bool operator==(const Merit&) const = default;
    bool operator<(const Merit& other) const {
        return std::pair(f1, agreeing) < std::pair(other.f1, other.agreeing);
    }
};

Merit merit(std::uint64_t hits, std::uint64_t false_alarms, std::uint64_t positives,
            std::uint64_t negatives) {
    const std::uint64_t twice_over = positives + hits + false_alarms;
    const double f1 =
        twice_over == 0 ? 0 : 2 * static_cast<double>(hits) / static_cast<double>(twice_over);
    return {f1, hits + negatives - false_alarms};
}

/// Label counts over all episodes of the numbers between two neighbouring ends of runs.
struct Cell {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

/// The numbers at which the label of some episode changes, and the label counts in between.
class Cells {
public:
    explicit Cells(const EachEpisode& episodes) {
        std::set<std::uint64_t> borders;
        episodes([&](const LabelRuns& episode) {
            for (const LabelRuns::Run& run : episode.runs()) borders.insert({run.begin, run.end});
        });
        borders_.assign(borders.begin(), borders.end());
        cells_.resize(borders_.empty() ? 0 : borders_.size() - 1);
        episodes([&](const LabelRuns& episode) { count(episode, true); });
    }

    /// Adds or removes the labels of an episode.
    void count(const LabelRuns& episode, bool adds) {
        for (const LabelRuns::Run& run : episode.runs()) {
            if (run.label == Label::unknown) continue;
            auto at = static_cast<std::size_t>(
                std::lower_bound(borders_.begin(), borders_.end(), run.begin) - borders_.begin());
            for (; borders_[at] < run.end; ++at) {
                const std::uint64_t numbers = borders_[at + 1] - borders_[at];
                Cell& cell = cells_[at];
                std::uint64_t& labels = run.label == Label::yes ? cell.positives : cell.negatives;
                labels = adds ? labels + numbers : labels - numbers;
            }
        }
    }

    /// Returns the best rule for the labels counted, or nothing where there are none.
    std::optional<Rule> best() const {
        std::uint64_t positives = 0;
        std::uint64_t negatives = 0;
        for (const Cell& cell : cells_) {
            positives += cell.positives;
            negatives += cell.negatives;
        }
        if (positives + negatives == 0) return std::nullopt;
        Merit best = merit(positives, negatives, positives, negatives);
        Rule rule = kAlwaysTrue;
        if (const Merit none = merit(0, 0, positives, negatives); best < none) {
            best = none;
            rule = kAlwaysFalse;
        }
        for (const bool from : {true, false}) improve(rule, best, from, positives, negatives);
        return rule;
    }

private:
    /// Replaces the rule where a better border exists. F1 and agreement are monotonic within a
    /// cell, so the borders suffice. Neighbouring borders of equal merit enclose numbers without
    /// labels.
    void improve(Rule& rule, Merit& best, bool from, std::uint64_t positives,
                 std::uint64_t negatives) const {
        std::uint64_t positives_below = 0;
        std::uint64_t negatives_below = 0;
        std::size_t first = 0;
        std::size_t last = 0;  // border as good as the best; 0: none yet
        for (std::size_t k = 1; k < cells_.size(); ++k) {
            positives_below += cells_[k - 1].positives;
            negatives_below += cells_[k - 1].negatives;
            const Merit here = from ? merit(positives - positives_below,
                                            negatives - negatives_below, positives, negatives)
                                    : merit(positives_below, negatives_below, positives, negatives);
            if (best < here) {
                best = here;
                first = last = k;
            } else if (last != 0 && last + 1 == k && best == here) {
                last = k;
            }
        }
        if (last == 0) return;
        rule.from = from;
        rule.threshold =
            (static_cast<double>(borders_[first]) + static_cast<double>(borders_[last])) / 2;
    }

    std::vector<std::uint64_t> borders_;
    std::vector<Cell> cells_;
};

void judge(const LabelRuns& episode, const Rule& rule, Counts& counts) {
    const auto first_from = static_cast<std::uint64_t>(std::ceil(rule.threshold));
    for (const LabelRuns::Run& run : episode.runs()) {
        const std::uint64_t border = std::clamp(first_from, run.begin, run.end);
        Counts below;
        Counts from;
        below.add(rule.from ? Label::no : Label::yes, run.label);
        from.add(rule.from ? Label::yes : Label::no, run.label);
        counts.add(below, border - run.begin);
        counts.add(from, run.end - border);
    }
}

}  // namespace

void LabelRuns::add(Label label) {
    if (runs_.empty() || runs_.back().label != label)
        runs_.push_back({next_, next_ + 1, label});
    else
        ++runs_.back().end;
    ++next_;
}

std::optional<Counts> judged_by_duration(const EachEpisode& episodes) {
    Cells cells(episodes);
    Counts counts;
    bool has_rules = true;
    episodes([&](const LabelRuns& episode) {
        if (!has_rules) return;
        cells.count(episode, false);
        const auto rule = cells.best();
        cells.count(episode, true);
        has_rules = rule.has_value();
        if (rule) judge(episode, *rule, counts);
    });
    if (!has_rules || counts.total() == 0) return std::nullopt;
    return counts;
}

}  // namespace etlc::evaluate
