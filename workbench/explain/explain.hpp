// Explains a verdict: the critical sample, a minimal set of samples that gives the same verdict,
// and the smallest change that would flip it. docs/explanations.md has the definitions. With every
// other sample missing the samples give the same verdict, and no subset of them does.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "explain/observations.hpp"
#include "ir/lower.hpp"

namespace etlc::explain {

/// The verdict to explain: rho(f, position, step).
struct Question {
    Index monitor = 0;  ///< of the model
    std::uint64_t position = 0;
    std::uint64_t step = 0;  ///< position <= step < observations.steps()
};

enum class Status : std::uint8_t { satisfied, violated, unknown };

/// A formula between the monitor's and the critical sample.
struct Link {
    Index formula = 0;           ///< of the model
    std::uint64_t position = 0;  ///< the step after the last one stands for the unseen future
    float robustness = 0;        ///< of the formula as written
};

/// Another measurement at one step, and the verdict that it would give.
struct Change {
    Sample sample;       ///< one of the samples that it changes
    float measured = 0;  ///< the new value
    Status status = Status::unknown;
    bool for_good = false;
};

struct Explanation {
    Status status = Status::unknown;
    /// Whether the verdict is final; then its finality is explained too.
    bool for_good = false;
    /// The deciding value, less the monitor's shift: of a final verdict the lower bound where
    /// satisfied, the upper one where violated; else rho where satisfied, its optimistic end where
    /// violated.
    float robustness = 0;
    /// The sample whose robustness that is; empty for the value of an empty window or of a
    /// constant, and for an unknown verdict.
    std::optional<Sample> critical;
    std::vector<Link> chain;      ///< from the monitor's formula down to the critical sample
    std::vector<Sample> samples;  ///< by step, then atom
    std::optional<Change> change;
    /// For an unknown verdict: the missing samples within reach, by step, then atom.
    std::vector<Sample> missing;
    std::vector<Sample> between;  ///< likewise: those that lie between two thresholds
};

Explanation explain(const ir::Program& program, const Observations& observations,
                    const Question& question);

}  // namespace etlc::explain
