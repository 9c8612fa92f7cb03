// Compares the output of a monitor with the reference.
// Takes: the spec, the reference's run and an observed one. Gives: the first mismatch as text.
// Keeps true: robustness and status must agree; the bounds must be at least as tight as the
// definition's and hold for every later step; `final` must follow from the bounds. Only differences
// within the rounding bound are allowed.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// The atoms that a monitor still uses: simplification may remove some that change no verdict, and
/// a step that lacks only those does not count as missing. (The comparison of the verdicts shows
/// that they change none.)
struct Dependencies {
    std::vector<bool> predicates;  ///< by index of the model
    /// Bool inputs in formulas, by index of the model's inputs.
    std::vector<bool> flags;
};

/// A run as a monitor shows it: robustness_high is not observable, and telemetry exists only for
/// the predicates that it computes.
struct Observed {
    struct Predicate {
        bool computed = false;
        double delta = 0;  ///< NaN: unknown
        std::optional<std::uint32_t> nearest;
        std::optional<double> threshold;  ///< adaptive thresholds, as used by this step
    };
    /// The result of why_NAME(); NaN and kNoRow: none.
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
    std::vector<std::vector<std::optional<Why>>> whys;  ///< only for classes with --explain
    std::vector<std::vector<reference::Verdict>> finish;
    /// The position of each verdict, if it is decided; empty: not observed.
    std::vector<std::vector<std::uint64_t>> positions;
    std::vector<std::vector<Predicate>> telemetry;
    std::uint32_t missing_steps = 0;
    Dependencies dependencies;
};

struct Comparison {
    /// Bound on |observed - expected| / max(1, |expected|); 0 if all arithmetic is exact in
    /// float32.
    double rounding = 0;
    /// Predicates are measured on demand: telemetry may be NaN where the reference has a number,
    /// and only missing samples of measured predicates count.
    bool on_demand = false;
};

std::optional<std::string> first_mismatch(const check::Model& model, const reference::Run& expected,
                                          const Observed& observed, const Comparison& comparison);

}  // namespace etlc::tests
