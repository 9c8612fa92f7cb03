// How often claims agree with the truth.
// Takes: pairs of what was said and what was true. Gives: precision, recall, F1 and agreement, and
// those of the two baselines that ignore the data. Keeps true: what could not be said (a missing
// sample) is a miss and never agrees; a rate without a case is no number.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "episodes/ranking/auroc.hpp"
#include "episodes/truth.hpp"

namespace etlc::evaluate {

using episodes::Label;

struct Counts {
    std::uint64_t true_positives = 0;
    std::uint64_t false_positives = 0;
    std::uint64_t false_negatives = 0;
    std::uint64_t true_negatives = 0;
    std::uint64_t unsaid_positives = 0;  ///< true, and neither said to be so nor not
    std::uint64_t unsaid_negatives = 0;
    std::uint64_t unlabelled = 0;  ///< where the truth is unknown: counted here, and nowhere else

    void add(Label said, Label is);
    /// The same counts, `times` over, on top of these.
    void add(const Counts& other, std::uint64_t times = 1);

    std::uint64_t positives() const { return true_positives + false_negatives + unsaid_positives; }
    std::uint64_t negatives() const { return true_negatives + false_positives + unsaid_negatives; }
    std::uint64_t total() const { return positives() + negatives(); }

    bool operator==(const Counts&) const = default;
};

template <class Archive>
void fields(Archive& archive, Counts& counts) {
    archive(counts.true_positives, counts.false_positives, counts.false_negatives,
            counts.true_negatives, counts.unsaid_positives, counts.unsaid_negatives,
            counts.unlabelled);
}

struct Rates {
    /// 2 TP / (2 TP + FP + misses): not defined where nothing is true or said.
    std::optional<double> f1;
    std::optional<double> precision;  ///< TP / (TP + FP)
    std::optional<double> recall;     ///< TP / positives
    std::optional<double> agreement;  ///< (TP + TN) / total
    std::optional<double> gain;       ///< F1, less that of saying true every time
};

Rates rates(const Counts& counts);
/// Of the sum over all episodes, in each resample.
std::vector<Rates> rates(const std::vector<Counts>& episodes, const episodes::Weights& weights);

/// Of a claim that is the same every time, on data of which these are true and the rest is not.
Rates rates_of_constant(bool claim, std::uint64_t positives, std::uint64_t total);

}  // namespace etlc::evaluate
