#include "plan/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "check/formulas/horizons.hpp"
#include "ir/lower.hpp"
#include "opt/opt.hpp"
#include "plan/plan.hpp"

namespace etlc::plan {

namespace {

using check::Formula;

/// Returns the cost of the plan, or nothing if it exceeds the limits.
std::optional<Cost> planned_cost(const check::Model& model, const Limits& limits,
                                 check::Values values) {
    ir::Program program = ir::lower(model);
    opt::optimise(program);
    diag::Sink unread;
    const auto found = plan(program, limits, unread, values);
    return found ? std::optional(found->cost) : std::nullopt;
}

/// Tries rewritings of one monitor in a model of its own.
class Rewriting {
public:
    Rewriting(const check::Model& model, Index monitor, Among among, const Limits& limits,
              check::Values values)
        : model_(model),
          monitor_(among == Among::all ? monitor : 0),
          limits_(limits),
          values_(values) {
        if (among != Among::alone) return;
        model_.monitors = {model.monitors[monitor]};
        for (check::Let& let : model_.lets) let.telemetry = false;
    }

    /// Tries a sliding monitor in place of `G f` or `F f`, or of a formula with a bounded future:
    /// it looks back at what the prefix has to foresee.
    std::optional<diag::Note> as_sliding_monitor() {
        check::Monitor& monitor = model_.monitors[monitor_];
        const check::Monitor written = monitor;
        const Formula& top = model_.formulas[written.formula];
        if (written.sliding || written.calibration) return std::nullopt;
        const bool is_unbounded = top.low == 0 && top.high == check::kUnbounded;
        const bool is_eventual = is_unbounded && top.kind == Formula::Kind::eventually;
        if (is_eventual || (is_unbounded && top.kind == Formula::Kind::always))
            monitor.formula = top.operands[0];
        const check::Reach reach = check::reaches(model_)[monitor.formula];
        monitor.sliding = true;
        monitor.horizon = static_cast<std::uint32_t>(reach.horizon);
        const bool possible = reach.unbounded == check::kNone && reach.horizon <= check::kMaxBound;
        const auto cost = possible ? planned_cost(model_, limits_, values_) : std::nullopt;
        const std::string formula = shown(model_, monitor.formula);
        monitor = written;
        if (!cost) return std::nullopt;
        return diag::Note{std::nullopt,
                          fmt::format("'sliding monitor {} = {}' fits: it reports every position, "
                                      "{} late, and takes {}{}",
                                      written.name, formula, diag::counted(reach.horizon, "step"),
                                      in_words(*cost),
                                      is_eventual ? "; one satisfied position satisfies F" : "")};
    }

    /// Shortens the longest window.
    std::optional<diag::Note> with_shorter_window() {
        const Index at = longest_window();
        if (at == check::kNone) return std::nullopt;
        const Formula written = model_.formulas[at];
        std::uint32_t fitting = 0;
        std::uint32_t failing = 1;
        for (; failing < written.high && fits(at, written, failing); failing *= 2)
            fitting = failing;
        failing = std::min(failing, written.high);
        for (int steps = 0; steps < kHalvings && fitting > 0 && failing - fitting > 1; ++steps) {
            const std::uint32_t middle = fitting + (failing - fitting) / 2;
            (fits(at, written, middle) ? fitting : failing) = middle;
        }
        if (fitting == 0) return std::nullopt;
        const std::uint32_t now = written.kind == Formula::Kind::count ? 1 : 0;  // this step
        return diag::Note{
            written.span,
            fmt::format("with {} in place of these {} it fits, and takes {}",
                        diag::counted(fitting + now, "step"), written.high + now, in_words(cost_))};
    }

private:
    static constexpr int kHalvings = 3;

    bool fits(Index at, const Formula& written, std::uint32_t high) {
        model_.formulas[at].high = high;
        model_.formulas[at].low = std::min(written.low, high);
        const std::vector<check::Reach> reaches = check::reaches(model_);
        for (check::Monitor& monitor : model_.monitors)
            if (monitor.sliding)
                monitor.horizon = static_cast<std::uint32_t>(reaches[monitor.formula].horizon);
        const auto cost = planned_cost(model_, limits_, values_);
        if (cost) cost_ = *cost;
        return cost.has_value();
    }

    /// Returns the longest window of more than a step in the monitor's formula, or kNone.
    Index longest_window() const {
        Index longest = check::kNone;
        for (const Index at : check::parts_of(model_, model_.monitors[monitor_].formula)) {
            const std::uint32_t high = model_.formulas[at].high;
            if (high > 1 && high != check::kUnbounded &&
                (longest == check::kNone || high > model_.formulas[longest].high))
                longest = at;
        }
        return longest;
    }

    check::Model model_;
    Index monitor_;
    const Limits& limits_;
    check::Values values_;
    Cost cost_;  ///< of the last that fitted
};

}  // namespace

Advice advice_on(const check::Model& model, const Limits& limits, check::Values values) {
    return [&model, &limits, values](Index monitor, Among among) {
        Rewriting rewriting(model, monitor, among, limits, values);
        std::vector<diag::Note> found;
        if (auto note = rewriting.as_sliding_monitor()) found.push_back(std::move(*note));
        if (auto note = rewriting.with_shorter_window()) found.push_back(std::move(*note));
        return found;
    };
}

}  // namespace etlc::plan
