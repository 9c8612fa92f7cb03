// Holds what a monitor said to what the reference says.
// Takes: the spec, the reference's run and an observed one. Gives: the first mismatch as text.
// Keeps true: robustness and status must agree; the bounds must be at least as tight as the
// definition's and hold for every later step; `final` must follow from the bounds. Nothing is
// excused but what lies within the rounding bound.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// The atoms that a monitor still looks at: simplification may find that some change no verdict,
/// and a step that lacks only those is not counted as missing. (That they change none is what the
/// comparison of the verdicts shows.)
struct Dependencies {
    std::vector<bool> predicates;  ///< by index of the model
    /// Bool inputs that stand in formulas, by index of the model's inputs.
    std::vector<bool> flags;
};

/// A run as a monitor shows it: robustness_high is not observable, telemetry only of the predicates
/// that it computes.
struct Observed {
    struct Predicate {
        bool computed = false;
        double delta = 0;  ///< NaN: unknown
        std::optional<std::uint32_t> nearest;
        std::optional<double> threshold;  ///< of adaptive ones, as this step used it
    };
    /// What why_NAME() says; NaN and kNoRow: nothing.
    struct Why {
        static constexpr std::uint32_t kNoRow = 0xffffffff;
        std::string predicate;
        std::uint32_t step = 0;
        float robustness = std::numeric_limits<float>::quiet_NaN();
        float distance = std::numeric_limits<float>::quiet_NaN();
        float threshold = std::numeric_limits<float>::quiet_NaN();
        std::uint32_t row = kNoRow;
    };
    std::vector<std::vector<reference::Verdict>> verdicts;
    std::vector<std::vector<std::optional<Why>>> whys;  ///< of classes that explain
    std::vector<std::vector<reference::Verdict>> finish;
    /// The position that each verdict is about, where it is decided; empty: not seen.
    std::vector<std::vector<std::uint64_t>> positions;
    std::vector<std::vector<Predicate>> telemetry;
    std::uint32_t missing_steps = 0;
    Dependencies dependencies;
};

struct Comparison {
    /// Bound on |observed - expected| / max(1, |expected|). 0 where all arithmetic is exact in
    /// float32.
    double rounding = 0;
    /// Predicates are measured on demand: telemetry may be NaN where the reference has a number,
    /// and of the steps that lack something only those count on which it was asked for.
    bool on_demand = false;
};

std::optional<std::string> first_mismatch(const check::Model& model, const reference::Run& expected,
                                          const Observed& observed, const Comparison& comparison);

}  // namespace etlc::tests
