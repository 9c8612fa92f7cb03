// The differential campaign: random formulas and traces, the plan's evaluator and compiled classes
// held to the reference. Takes: how much to try, and a seed. Gives: a tally, and every mismatch,
// made small, as a spec and a trace. Keeps true: a formula counts as refused only for its size,
// under the limits that `etlc` has by default.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "shrink.hpp"
#include "subject.hpp"
#include "whys.hpp"

namespace etlc::tests {

struct Effort {
    std::uint64_t seed = 1;
    int pairs = 100'000;   ///< of a formula and a trace, for the evaluator
    int planned = 20'000;  ///< formulas that are only planned, for the share that is refused
    int compiled = 2'000;  ///< formulas in compiled classes
    int explained = 0;     ///< pairs whose verdict is explained
    int builds = 4;        ///< of each: as is, -ffast-math, -Os by clang++, with sanitizers
    std::size_t longest = 200;
    bool show_refused = false;
};

struct Tally {
    struct Cell {
        int formulas = 0;
        int refused = 0;
        double share() const { return formulas == 0 ? 0 : static_cast<double>(refused) / formulas; }
    };
    /// By depth - 1. Prefix monitors with windows to kLongWindow, with all operators and mostly
    /// future ones; with windows to kShortWindow; sliding ones; all of these on truth values.
    using Row = std::array<Cell, kDepths>;
    Row long_windows;
    Row mostly_future;
    Row short_windows;
    Row sliding;
    Row boolean;
    int pairs = 0;
    int compiled = 0;
    WhyTally whys;  ///< of compiled classes
    int explained = 0;
    int for_good = 0;      ///< of these: verdicts that are final
    int with_samples = 0;  ///< of these: the explanation has some
    int with_change = 0;   ///< and it knows what would turn the verdict
    std::vector<Finding> findings;
    /// There is enough to repair: the campaign ends.
    bool enough() const { return findings.size() >= 10; }

    Cell& cell(const Subject& subject) {
        Row& row = subject.values == check::Values::boolean ? boolean
                   : subject.sliding()                      ? sliding
                   : subject.shape.window == kShortWindow   ? short_windows
                   : subject.shape.future == kMostlyFuture  ? mostly_future
                                                            : long_windows;
        return row[static_cast<std::size_t>(subject.shape.depth - 1)];
    }
};

/// The evaluator behind `etlc run` on random pairs, continuations of prefixes among them.
void try_pairs(const Effort& effort, Tally& tally);

/// Plans formulas without running them.
void try_plans(const Effort& effort, Tally& tally);

/// Classes of many monitors, compiled; formulas that are refused are left out.
void try_compiled(const Effort& effort, Tally& tally);

/// Explanations of random pairs, at random positions.
void try_explanations(const Effort& effort, Tally& tally);

}  // namespace etlc::tests
