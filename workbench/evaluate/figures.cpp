#include "evaluate/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

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

/// Predicts true for the numbers from `from` up to but excluding `below`.
struct Rule {
    double from = 0;
    double below = std::numeric_limits<double>::infinity();
};

/// Label counts over all episodes.
struct Cell {
    std::uint64_t positives = 0;
    std::uint64_t negatives = 0;
};

/// The quality of a rule, compared lexicographically: F1, then the number that agree.
using Merit = std::pair<double, std::uint64_t>;

/// Returns the merit of predicting true for `inside`, some of `all`.
Merit merit(const Cell& all, const Cell& inside) {
    const std::uint64_t twice_over = all.positives + inside.positives + inside.negatives;
    const double f1 = twice_over == 0 ? 0
                                      : 2 * static_cast<double>(inside.positives) /
                                            static_cast<double>(twice_over);
    return {f1, inside.positives + all.negatives - inside.negatives};
}

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
        const Cell all = labels_in({0, cells_.size()});
        if (all.positives + all.negatives == 0) return std::nullopt;
        Rule rule;  // always true
        Cell hits = all;
        Merit best = merit(all, hits);
        if (const Merit never = merit(all, {}); best < never) {
            best = never;
            rule.below = 0;
        }
        // Dinkelbach, "On nonlinear fractional programming", 1967: among the intervals, the one
        // with the greatest 2 hits - F1 x predictions has a greater F1, until none has.
        bool is_constant = true;
        for (;;) {
            const Stretch found = stretch(all, hits);
            const Cell inside = labels_in(found);
            const Merit here = merit(all, inside);
            if (!(best < here) && (is_constant || here < best)) return rule;
            rule = rule_of(found);
            if (!(best < here)) return rule;  // the first of equals
            best = here;
            hits = inside;
            is_constant = false;
        }
    }

private:
    __extension__ using Wide = __int128;  // products of numbers of frames

    /// The gain of predicting true in a cell: in 2 hits - F1 x predictions, and in agreement.
    struct Gain {
        Wide of_f1 = 0;
        std::int64_t agreeing = 0;

        auto operator<=>(const Gain&) const = default;
        Gain& operator+=(const Gain& other) {
            of_f1 += other.of_f1;
            agreeing += other.agreeing;
            return *this;
        }
    };

    /// Returns the cells with the greatest 2 hits - F1 x predictions, where F1 is that of `before`,
    /// and of these the ones that agree most.
    Stretch stretch(const Cell& all, const Cell& before) const {
        const Wide twice_hits = 2 * Wide{before.positives};
        const Wide twice_over = Wide{all.positives} + before.positives + before.negatives;
        const auto gain = [&](std::size_t k) {
            const auto& [positives, negatives] = cells_[k];
            return Gain{
                2 * Wide{positives} * twice_over - twice_hits * (Wide{positives} + negatives),
                static_cast<std::int64_t>(positives) - static_cast<std::int64_t>(negatives)};
        };
        return greatest_stretch<Gain>(cells_.size(), gain).value_or(Stretch{});
    }

    Cell labels_in(const Stretch& of) const {
        Cell sum;
        for (std::size_t k = of.first; k < of.end; ++k) {
            sum.positives += cells_[k].positives;
            sum.negatives += cells_[k].negatives;
        }
        return sum;
    }

    /// Returns the rule whose borders are halfway between the labels inside and those outside.
    Rule rule_of(const Stretch& of) const {
        const auto is_empty = [&](std::size_t k) {
            return cells_[k].positives + cells_[k].negatives == 0;
        };
        std::size_t before = of.first;
        while (before > 0 && is_empty(before - 1)) --before;
        std::size_t after = of.end;
        while (after < cells_.size() && is_empty(after)) ++after;
        Rule rule;
        if (before > 0) rule.from = halfway(before, of.first);
        if (after < cells_.size()) rule.below = halfway(of.end, after);
        return rule;
    }
    double halfway(std::size_t a, std::size_t b) const {
        return (static_cast<double>(borders_[a]) + static_cast<double>(borders_[b])) / 2;
    }

    std::vector<std::uint64_t> borders_;
    std::vector<Cell> cells_;  ///< of the numbers between two neighbouring borders
};

void judge(const LabelRuns& episode, const Rule& rule, Counts& counts) {
    const auto first_at = [](double border) {
        return static_cast<std::uint64_t>(std::ceil(std::min(border, 0x1p63)));
    };
    for (const LabelRuns::Run& run : episode.runs()) {
        const std::uint64_t first = std::clamp(first_at(rule.from), run.begin, run.end);
        const std::uint64_t end = std::clamp(first_at(rule.below), first, run.end);
        Counts inside;
        Counts outside;
        inside.add(Label::yes, run.label);
        outside.add(Label::no, run.label);
        counts.add(inside, end - first);
        counts.add(outside, run.end - run.begin - (end - first));
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
