// Evaluates monitors by brute force, straight from docs/semantics.md: the judge in tests. It shares
// nothing with ir/ and later stages and no arithmetic with the runtime; distances are computed in
// double; it is written for clarity before speed (memoised recursion per prefix).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "check/model/model.hpp"

namespace etlc::reference {

/// One step of a trace: per input of the model, its numbers; empty where the sample is missing.
/// A bool is 0 or 1; an f16 or i8 embedding holds its real values.
using Step = std::vector<std::vector<double>>;
using Trace = std::vector<Step>;

enum class Status : std::uint8_t { satisfied, violated, unknown, undecided };

struct Verdict {
    Status status = Status::undecided;
    bool final = false;
    double lower = 0;
    double robustness = 0;
    double robustness_high = 0;  ///< rho with unknown literals at the high end of their range
    double upper = 0;
};

struct Telemetry {
    double delta = 0;           ///< NaN where the predicate is unknown
    std::uint32_t nearest = 0;  ///< row of the nearest target, for plain distances
};

struct Run {
    /// verdicts[step][monitor], as after `step` steps have been seen.
    std::vector<std::vector<Verdict>> verdicts;
    /// positions[step][monitor]: the position of the verdict, where it is decided.
    std::vector<std::vector<std::uint64_t>> positions;
    /// finish[call][monitor]: the calls of finish() after the trace, as many as the largest
    /// horizon.
    std::vector<std::vector<Verdict>> finish;
    /// telemetry[step][predicate]
    std::vector<std::vector<Telemetry>> telemetry;
    /// present[step][input]: the sample was there and valid, or held.
    std::vector<std::vector<bool>> present;
    /// Steps at which some predicate or bool of a monitor was unknown, after hold.
    std::uint32_t missing_steps = 0;
};

/// thresholds[step][predicate]: the epsilon that each adaptive predicate has at each step. Entries
/// of other predicates are ignored; without any, adaptive thresholds stay where they start.
using Thresholds = std::vector<std::vector<double>>;

/// requests[step][monitor]: the program restarted that monitor before the step.
using Requests = std::vector<std::vector<bool>>;

/// Evaluates all monitors. With Boolean values a predicate is true (+inf) or false (-inf) as its
/// comparison says, in double, and its unseen values are those of its comparison over the range of
/// its expression. Without thresholds, adaptive ones stay where they start.
Run evaluate(const check::Model& model, const Trace& trace,
             check::Values values = check::Values::robustness, const Thresholds& thresholds = {},
             const Requests& requests = {});

}  // namespace etlc::reference
