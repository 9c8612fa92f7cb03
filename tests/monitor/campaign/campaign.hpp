// The differential campaign: compares the plan's evaluator and compiled classes with the reference
// on random formulas and traces. Takes: the amount of work, and a seed. Gives: a tally, and every
// mismatch, minimised, as a spec and a trace. Keeps true: a formula counts as refused only for its
// size, under the default limits of `etlc`.
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
    int pairs = 100'000;   ///< pairs of a formula and a trace, for the evaluator
    int planned = 20'000;  ///< formulas that are only planned, to count refusals
    int compiled = 2'000;  ///< formulas in compiled classes
    int explained = 0;     ///< pairs with an explained verdict
    int builds = 4;        ///< programs of each kind: plain, -ffast-math, -Os by clang++, with
                           ///< sanitizers
    std::size_t longest = 200;
    bool show_refused = false;
};

struct Tally {
    struct Cell {
        int formulas = 0;
        int refused = 0;
        double share() const { return formulas == 0 ? 0 : static_cast<double>(refused) / formulas; }
    };
    /// By depth - 1: prefix monitors with windows to kLongWindow, with all operators and mostly
    /// future ones; with windows to kShortWindow; sliding ones; and all of these on truth values.
    using Row = std::array<Cell, kDepths>;
    Row long_windows;
    Row mostly_future;
    Row short_windows;
    Row sliding;
    Row boolean;
    int pairs = 0;
    int compiled = 0;
    WhyTally whys;  ///< verdicts of compiled classes
    int explained = 0;
    int for_good = 0;      ///< of these, final verdicts
    int with_samples = 0;  ///< of these, explanations with samples
    int with_change = 0;   ///< of these, with a change that flips the verdict
    std::vector<Finding> findings;
    /// Enough mismatches: the campaign ends.
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

/// Runs the evaluator behind `etlc run` on random pairs, including continuations of prefixes.
void try_pairs(const Effort& effort, Tally& tally);

/// Plans formulas without running them.
void try_plans(const Effort& effort, Tally& tally);

/// Compiles classes of many monitors, without formulas that are refused.
void try_compiled(const Effort& effort, Tally& tally);

/// Explains random pairs at random positions.
void try_explanations(const Effort& effort, Tally& tally);

}  // namespace etlc::tests
