// The duration baseline: a threshold on the length of an episode, or on the number of a step, and
// nothing else. Each episode is judged by the rule with the greatest F1 on all others. Memory grows
// with the different numbers at which labels change.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "evaluate/figures.hpp"

namespace etlc::evaluate {

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

/// Counts what rules of the form "true from a number on" or "true below a number" get right. Ties
/// in F1, then in agreement, go to: always true, always false, the first rule of the former kind,
/// the first of the latter. A threshold lies halfway between the numbers that it separates. Returns
/// nothing where fewer than two episodes have a known label.
std::optional<Counts> judged_by_duration(const EachEpisode& episodes);

}  // namespace etlc::evaluate
