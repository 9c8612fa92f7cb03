// The plan's evaluator as a system under test.
// Takes: a typed spec. Gives: what the evaluator says on a trace. Keeps true: runs are independent
// of each other, but for what labels did to thresholds.
#pragma once

#include <optional>
#include <string>

#include "adaptive.hpp"
#include "check/model/model.hpp"
#include "compare.hpp"
#include "plan/evaluate/evaluator.hpp"
#include "plan/plan.hpp"
#include "reference/reference.hpp"

namespace etlc::tests {

/// Above what any spec of the tests needs: all operators at once are more than one monitor class
/// should hold.
constexpr plan::Limits kRoomy{16U << 20U, 16U << 20U, 64U << 20U};

class PlanRunner {
public:
    /// The model must outlive the runner. `limits` as `etlc` takes them.
    explicit PlanRunner(const check::Model& model, const plan::Limits& limits = {},
                        check::Values values = check::Values::robustness);

    /// Empty where the spec was planned; else the codes of the errors, separated by spaces.
    const std::string& refusal() const { return refusal_; }
    /// The atoms that the plan computes.
    Dependencies dependencies() const;
    /// A run from reset to the last call of finish(), with labels before each step. Adaptive
    /// thresholds go on from where the last run left them.
    Observed run(const reference::Trace& trace, const Labels* labels = nullptr);

private:
    const check::Model& model_;
    std::optional<plan::Plan> plan_;
    std::optional<plan::Evaluator> evaluator_;
    std::string refusal_;

    std::vector<reference::Verdict> verdicts(const std::vector<etlmon::Verdict>& from) const;
    /// In place of what sliding monitors say, what lets of the same formulas do; not of shifted
    /// monitors, whose lets are not.
    void take_from_lets(std::vector<reference::Verdict>& verdicts) const;
    std::vector<Observed::Predicate> telemetry() const;
    std::vector<std::uint64_t> positions() const;
};

/// A step of a trace as an evaluator takes it.
std::vector<plan::Sample> samples_of(const reference::Step& step);

/// A verdict of the runtime in the reference's terms.
reference::Verdict observed(const etlmon::Verdict& verdict);

}  // namespace etlc::tests
