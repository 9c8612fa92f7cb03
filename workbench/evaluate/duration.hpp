// What the length of an episode says by itself, or at a step the number of the step.
// Takes: the true labels of every episode. Gives: what a threshold on that number alone gets right,
// leaving one out: every episode is judged by the rule that has the greatest F1 on all others.
// Keeps true: the rule has not seen the episode that it judges; memory is that of the different
// numbers at which labels change.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "evaluate/counts.hpp"

namespace etlc::evaluate {

/// The labels of consecutive numbers, as runs of equal ones.
class LabelRuns {
public:
    struct Run {
        std::uint64_t begin = 0;
        std::uint64_t end = 0;  ///< the first number behind it
        Label label = Label::unknown;
        bool operator==(const Run&) const = default;
    };

    /// `first`: the number of the first label.
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

/// Calls its argument with the labels of each episode, in their order, as often as it is called.
using EachEpisode = std::function<void(const std::function<void(const LabelRuns&)>&)>;

/// "True from a number on" or "true below a number". Of rules that get the same F1 and then the
/// same agreement: always true, always false, the first of the former, the first of the latter,
/// with the threshold halfway between the numbers that it separates. Nothing where no two episodes
/// have a known label.
std::optional<Counts> judged_by_duration(const EachEpisode& episodes);

}  // namespace etlc::evaluate
