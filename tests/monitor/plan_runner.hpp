// Runs the plan's evaluator for tests.
// Takes: a typed spec. Gives: the evaluator's output for a trace. Keeps true: runs are independent
// of each other, except for thresholds that labels have moved.
#pragma once

#include <optional>
#include <string>

#include "adaptive.hpp"
#include "check/model/model.hpp"
#include "compare.hpp"
#include "execute/evaluator.hpp"
#include "plan/plan.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// More than any spec of the tests needs: all operators together exceed the default limits.
constexpr plan::Limits kRoomy{16U << 20U, 16U << 20U, 64U << 20U};

class PlanRunner {
public:
    /// The model must outlive the runner. `limits` as in `etlc`.
    explicit PlanRunner(const check::Model& model, const plan::Limits& limits = {},
                        check::Values values = check::Values::robustness);

    /// Empty if the spec was planned; else the codes of the errors, separated by spaces.
    const std::string& refusal() const { return refusal_; }
    const plan::Cost& cost() const { return plan_->cost; }
    std::string text() const { return plan::print(*plan_); }
    /// The atoms that the plan computes.
    Dependencies dependencies() const;
    /// Runs from reset to the last call of finish(), with labels before each step. Adaptive
    /// thresholds continue from the previous run.
    Observed run(const reference::Trace& trace, const Labels* labels = nullptr);

private:
    const check::Model& model_;
    std::optional<plan::Plan> plan_;
    std::optional<execute::Evaluator> evaluator_;
    std::string refusal_;

    std::vector<reference::Verdict> verdicts(const std::vector<etlmon::Verdict>& from) const;
    /// Replaces the output of sliding monitors by that of lets with the same formulas, except for
    /// shifted monitors.
    void take_from_lets(std::vector<reference::Verdict>& verdicts) const;
    std::vector<Observed::Predicate> telemetry() const;
    std::vector<std::uint64_t> positions() const;
};

/// A step of a trace in the format of the evaluator.
std::vector<execute::Sample> samples_of(const reference::Step& step);

/// Converts a verdict of the runtime to the reference's type.
reference::Verdict observed(const etlmon::Verdict& verdict);

}  // namespace etlc::tests
