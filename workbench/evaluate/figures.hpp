// Counts of predictions that agree or disagree with the truth, and their rates. An unknown
// prediction, between two thresholds or of a missing sample, is no error, but never agrees either;
// a rate without a case is undefined.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "episodes/bootstrap.hpp"
#include "episodes/truth.hpp"

namespace etlc::evaluate {

using episodes::Bootstrap;
using episodes::Figure;
using episodes::Fraction;
using episodes::Interval;
using episodes::kResamples;
using episodes::Label;
using episodes::percentile_interval;
using episodes::share;
using episodes::Weights;

struct Counts {
    std::uint64_t true_positives = 0;
    std::uint64_t false_positives = 0;
    std::uint64_t false_negatives = 0;
    std::uint64_t true_negatives = 0;
    std::uint64_t unknown_positives = 0;  ///< true, and the prediction is unknown
    std::uint64_t unknown_negatives = 0;
    std::uint64_t unlabelled = 0;  ///< cases of unknown truth, which no other count includes

    void add(Label predicted, Label actual);
    /// Adds the other counts, `times` over.
    void add(const Counts& other, std::uint64_t times = 1);

    std::uint64_t positives() const { return true_positives + false_negatives + unknown_positives; }
    std::uint64_t negatives() const { return true_negatives + false_positives + unknown_negatives; }
    std::uint64_t total() const { return positives() + negatives(); }
    std::uint64_t wrong() const { return false_positives + false_negatives; }
    std::uint64_t unknown() const { return unknown_positives + unknown_negatives; }

    bool operator==(const Counts&) const = default;
};

/// Returns whether a prediction is an error.
constexpr bool is_wrong(Label predicted, Label actual) {
    return predicted != actual && predicted != Label::unknown && actual != Label::unknown;
}

/// All counts with their names.
inline constexpr std::pair<const char*, std::uint64_t Counts::*> kCounts[] = {
    {"true_positives", &Counts::true_positives},
    {"false_positives", &Counts::false_positives},
    {"false_negatives", &Counts::false_negatives},
    {"true_negatives", &Counts::true_negatives},
    {"unknown_positives", &Counts::unknown_positives},
    {"unknown_negatives", &Counts::unknown_negatives},
    {"unlabelled", &Counts::unlabelled}};

template <class Archive>
void fields(Archive& archive, Counts& counts) {
    for (const auto& [name, count] : kCounts) archive(counts.*count);
}

/// A value for each rate.
template <class T>
struct ByRate {
    /// 2 TP / (2 TP + FP + misses); undefined where nothing is true or predicted.
    T f1;
    T precision;            ///< TP / (TP + FP)
    T recall;               ///< TP / positives
    T agreement;            ///< (TP + TN) / total
    T unknown;              ///< (unknown positives + unknown negatives) / total
    T wrong_when_decided;   ///< (FP + FN) / (TP + FP + FN + TN)
    T false_negative_rate;  ///< FN / positives
    T false_positive_rate;  ///< FP / negatives

    /// Calls `visit(name, value)` for the rates of agreement.
    template <class Visit>
    void for_each(Visit&& visit) const {
        visit("f1", f1);
        visit("precision", precision);
        visit("recall", recall);
        visit("agreement", agreement);
    }
    /// Calls `visit(name, value)` for the share of unknown predictions and the rates of errors.
    template <class Visit>
    void for_each_error(Visit&& visit) const {
        visit("unknown", unknown);
        visit("wrong_when_decided", wrong_when_decided);
        visit("false_negative_rate", false_negative_rate);
        visit("false_positive_rate", false_positive_rate);
    }
};

struct Rates : ByRate<std::optional<double>> {
    std::optional<double> gain;  ///< F1 less the F1 of always predicting true
    /// The shares of the positives and of the negatives that are called so, on average.
    std::optional<double> decided;
};
using Rate = std::optional<double> Rates::*;

/// Calls `get(rate)` for each rate.
template <class Get>
ByRate<std::invoke_result_t<Get, Rate>> by_rate(const Get& get) {
    return {get(&Rates::f1),
            get(&Rates::precision),
            get(&Rates::recall),
            get(&Rates::agreement),
            get(&Rates::unknown),
            get(&Rates::wrong_when_decided),
            get(&Rates::false_negative_rate),
            get(&Rates::false_positive_rate)};
}

/// Returns the mean of those that are defined.
std::optional<double> mean(std::optional<double> a, std::optional<double> b);

Rates rates(const Counts& counts);
/// Returns for each resample the rates of the summed counts.
std::vector<Rates> rates(const std::vector<Counts>& episodes, const Weights& weights);

/// Returns the rates of a constant prediction on `total` cases, `positives` of which are true.
Rates rates_of_constant(bool prediction, std::uint64_t positives, std::uint64_t total);

// ---- the duration baseline ----------------------------------------------------------------------
// The duration baseline: a clock with two ends, on the length of an episode, or on the number of a
// step, and nothing else. Each episode is judged by the rule with the greatest F1 on all others.
// Memory grows with the different numbers at which labels change.

/// Neighbours from `first` up to but excluding `end`.
struct Stretch {
    std::size_t first = 0;
    std::size_t end = 0;
};

/// Returns the neighbours with the greatest sum of weights; of equals those that end first, and of
/// these those that begin last. Nothing where no sum is above `Sum{}`. Source: Kadane's scan
/// (Bentley, "Programming Pearls", 1984).
template <class Sum, class Weight>
std::optional<Stretch> greatest_stretch(std::size_t count, const Weight& weight) {
    std::optional<Stretch> best;
    Sum greatest{};
    Sum running{};
    std::size_t first = 0;
    for (std::size_t k = 0; k < count; ++k) {
        if (running <= Sum{}) {
            running = Sum{};
            first = k;
        }
        running += weight(k);
        if (running <= greatest) continue;
        greatest = running;
        best = Stretch{first, k + 1};
    }
    return best;
}

/// Labels of consecutive numbers, as runs of equal labels.
class LabelRuns {
public:
    struct Run {
        std::uint64_t begin = 0;
        std::uint64_t end = 0;  ///< the first number after the run
        Label label = Label::unknown;
        bool operator==(const Run&) const = default;
    };

    /// `first` is the number of the first label.
    explicit LabelRuns(std::uint64_t first = 0) : next_(first) {}

    void add(Label label);
    const std::vector<Run>& runs() const { return runs_; }

    bool operator==(const LabelRuns&) const = default;

    template <class Archive>
    friend void fields(Archive& archive, LabelRuns& labels) {
        archive(labels.next_, labels.runs_);
    }
    template <class Archive>
    friend void fields(Archive& archive, Run& run) {
        archive(run.begin, run.end, run.label);
    }

private:
    std::uint64_t next_;
    std::vector<Run> runs_;
};

/// Calls its argument with the labels of each episode, in order; may be called repeatedly.
using EachEpisode = std::function<void(const std::function<void(const LabelRuns&)>&)>;

/// Counts what rules of the form "true from a number on and below another" get right. Either end
/// may be open. Ties in F1, then in agreement, go to: always true, always false, the rule whose
/// last number inside is the least, of these the one whose first is the greatest. An end lies
/// halfway between the numbers that it separates. Returns nothing where fewer than two episodes
/// have a known label.
std::optional<Counts> judged_by_duration(const EachEpisode& episodes);

}  // namespace etlc::evaluate
