// Why a verdict is what it is: the critical sample, the samples that it rests on, and what would
// turn it. docs/explanations.md has the definitions.
// Takes: formulas as ir::lower gives them, the observations of a trace, and a monitor's position
// and step. Gives: an explanation in samples and formulas. Keeps true: with every other sample
// missing the samples give the same verdict, and no fewer of them do; the change was tried, and the
// verdict turned.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "explain/observations.hpp"
#include "ir/lower.hpp"

namespace etlc::explain {

/// What a monitor says about a position after a step: rho(f, position, step).
struct Question {
    Index monitor = 0;  ///< of the model
    std::uint64_t position = 0;
    std::uint64_t step = 0;  ///< position <= step < observations.steps()
};

enum class Status : std::uint8_t { satisfied, violated, unknown };

/// A formula on the way from the monitor's to the critical sample.
struct Link {
    Index formula = 0;           ///< of the model
    std::uint64_t position = 0;  ///< the one after the step: all that may come
    float robustness = 0;        ///< of the formula as written
};

/// Another measurement of one step, and what the monitor would then say.
struct Change {
    Sample sample;       ///< one of those that it concerns
    float measured = 0;  ///< instead; of a bool, the other value
    Status status = Status::unknown;
    bool for_good = false;
};

struct Explanation {
    Status status = Status::unknown;
    /// Whether it stays so whatever follows; then that is what is explained.
    bool for_good = false;
    /// What decides: for good the lower bound where satisfied, the upper one where violated; so far
    /// rho where satisfied, its optimistic end where violated. Less the monitor's shift.
    float robustness = 0;
    /// Whose robustness that is; nothing where it is that of an empty window or a constant, and of
    /// an unknown verdict.
    std::optional<Sample> critical;
    std::vector<Link> chain;      ///< from the monitor's formula down to it
    std::vector<Sample> samples;  ///< by step, then atom
    std::optional<Change> change;
    /// Of an unknown verdict: the samples within its reach that are missing, by step, then atom.
    std::vector<Sample> missing;
};

Explanation explain(const ir::Program& program, const Observations& observations,
                    const Question& question);

}  // namespace etlc::explain
