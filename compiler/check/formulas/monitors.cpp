// Checks monitors: which operators each kind may have, and by how many steps a sliding verdict is
// delayed.
#include <fmt/format.h>

#include <algorithm>

#include "check/context/context.hpp"
#include "check/formulas/durations.hpp"
#include "check/formulas/formulas.hpp"
#include "check/formulas/horizons.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/points/points.hpp"

namespace etlc::check {

namespace {

using diag::Code;

class MonitorCheck {
public:
    explicit MonitorCheck(Context& context) : c_(context), reaches_(reaches(context.model)) {}

    void measure(Monitor& monitor) const {
        const Reach& reach = reaches_[monitor.formula];
        if (monitor.restarts == Restarts::when_final && reach.unbounded == kNone &&
            reach.horizon <= kMaxBound)
            monitor.ahead = static_cast<std::uint32_t>(reach.horizon);
    }

    void sliding(Monitor& monitor, Span name) {
        const Reach& reach = reaches_[monitor.formula];
        if (reach.unbounded != kNone) {
            report_all(monitor, &Reach::unbounded, reported_unbounded_,
                       [&](Index at) { report_unbounded(monitor, name, at); });
            return;
        }
        if (reach.horizon > kMaxBound) {
            c_.report(Code::horizon_too_large, name,
                      fmt::format("'{}' looks further ahead than {} steps: the sum of the upper "
                                  "bounds along its deepest path",
                                  monitor.name, kMaxBound));
            return;
        }
        monitor.horizon = static_cast<std::uint32_t>(reach.horizon);
    }

    void prefix(const Monitor& monitor, Span name) {
        if (reaches_[monitor.formula].past_over_future == kNone) return;
        report_all(monitor, &Reach::past_over_future, reported_past_,
                   [&](Index at) { report_past(monitor, name, at); });
    }

private:
    std::string_view word(Index formula) const {
        return ast::operator_of(c_.model.formulas[formula].kind)->symbol;
    }

    /// If the operator is in a let, notes where the let is used.
    void note_use(diag::Diagnostic& error, Span user, Span shown, Index at,
                  std::string text) const {
        const Span place = c_.operator_spans[at];
        const bool inside = user.begin <= place.begin && place.end <= user.end;
        if (!inside) error.note(shown, std::move(text));
    }

    /// Calls `report` for each node below the monitor that `what` names as its own reach, once for
    /// all monitors.
    template <class Report>
    void report_all(const Monitor& monitor, Index Reach::*what, std::vector<bool>& visited,
                    Report report) {
        visited.resize(c_.model.formulas.size());
        std::vector<Index> pending{monitor.formula};
        while (!pending.empty()) {
            const Index at = pending.back();
            pending.pop_back();
            if (visited[at] || reaches_[at].*what == kNone) continue;
            visited[at] = true;
            if (reaches_[at].*what == at) report(at);
            for (const Index operand : c_.model.formulas[at].operands) pending.push_back(operand);
        }
    }

    void report_unbounded(const Monitor& monitor, Span name, Index at) {
        auto& error = c_.report(
            Code::unbounded_future, c_.operator_spans[at],
            fmt::format("{} looks ahead without bound, so a sliding verdict would wait forever",
                        word(at)));
        note_use(error, monitor.span, name, at,
                 fmt::format("sliding monitor '{}' uses it", monitor.name));
        error.note(c_.model.formulas[at].kind == Formula::Kind::weak_until
                       ? "W has no bounded form; p W[0, b] q is written (p U[0, b] q) || G[0, b] p"
                       : "give it an interval, such as [0, 20], or remove 'sliding'");
    }

    void report_past(const Monitor& monitor, Span name, Index at) {
        Index future = kNone;
        for (const Index operand : c_.model.formulas[at].operands)
            if (future == kNone) future = reaches_[operand].future;
        auto& error = c_.report(
            Code::past_over_future, c_.operator_spans[at],
            fmt::format(
                "{} looks back over an operand that looks ahead, which a prefix monitor cannot do",
                word(at)));
        error.note(c_.operator_spans[future], fmt::format("{} looks ahead here", word(future)));
        note_use(error, monitor.span, name, at, fmt::format("monitor '{}' uses it", monitor.name));
        error.note("a sliding monitor can, if the future is bounded");
    }

    Context& c_;
    std::vector<Reach> reaches_;
    std::vector<bool> reported_unbounded_;
    std::vector<bool> reported_past_;
};

/// The guarantee of a shift or duration holds for the thresholds that it was fitted with.
void refuse_moving_thresholds(Context& c, const Monitor& monitor, Span at_fault,
                              std::string_view what) {
    const auto parts = parts_of(c.model, monitor.formula);
    const auto at = std::find_if(parts.begin(), parts.end(), [&](Index part) {
        const Formula& formula = c.model.formulas[part];
        return formula.kind == Formula::Kind::predicate &&
               c.model.predicates[formula.index].threshold.adaptation.has_value();
    });
    if (at == parts.end()) return;
    c.report(Code::calibration_not_available, at_fault,
             fmt::format("'{}' {}, which needs fixed thresholds; that of '{}' is adaptive",
                         monitor.name, what, c.model.predicates[c.model.formulas[*at].index].name))
        .note(c.model.formulas[*at].span, "it is used here");
}

/// A predicate over an embedding gets its truth by its name; compared with itself it would always
/// agree.
void refuse_comparisons_without_truth(Context& c, const Monitor& monitor) {
    const Index at = node_without_truth(c.model, monitor.true_formula());
    if (at == kNone) return;
    const std::string comparison = c.model.predicates[c.model.formulas[at].index].shown();
    c.report(Code::calibration_not_available, monitor.calibration->span,
             fmt::format("'{}' is calibrated as a whole, against the truths of its predicates; "
                         "'{}' has no name and therefore no truth",
                         monitor.name, comparison))
        .note(c.model.formulas[at].span, "it is used here")
        .note(fmt::format("declare it, as in 'predicate near = {};', and give it a truth: 'truth "
                          "near = ...;' or an array truth.near in the episodes",
                          comparison));
}

Restarts restarts(ast::Monitor::Kind kind) {
    if (kind == ast::Monitor::Kind::restartable) return Restarts::on_request;
    return kind == ast::Monitor::Kind::repeating ? Restarts::when_final : Restarts::never;
}

/// The positions of a restarting monitor depend on its verdicts, and these on the shift.
bool moves_with_its_shift(Context& c, const Monitor& monitor) {
    if (monitor.restarts == Restarts::never) return false;
    c.report(Code::calibration_not_available, monitor.calibration->span,
             fmt::format("'{}' restarts at steps that its shift would change; only a monitor with "
                         "fixed positions can be calibrated as a whole",
                         monitor.name))
        .note("calibrate its predicates, or remove 'restartable' or 'repeating'");
    return true;
}

}  // namespace

void check_monitors(Context& c) {
    for_each_declaration<ast::Monitor>(c.spec, [&](const ast::Monitor& declaration, Index index) {
        Monitor monitor;
        monitor.name = declaration.name.text;
        monitor.span = declaration.span;
        monitor.sliding = declaration.kind == ast::Monitor::Kind::sliding;
        monitor.restarts = restarts(declaration.kind);
        c.duration = &monitor.duration;
        monitor.formula = check_formula(c, *declaration.formula);
        c.duration = nullptr;
        if (declaration.calibrated)
            monitor.calibration = check_monitor_calibrated(c, *declaration.calibrated);
        if (monitor.formula == kNone) c.scope.entity(NameKind::monitor, index).broken = true;
        c.model.monitors.push_back(std::move(monitor));
    });
    MonitorCheck check(c);
    for (Index i = 0; i < c.model.monitors.size(); ++i) {
        Monitor& monitor = c.model.monitors[i];
        const Span name = c.scope.entity(NameKind::monitor, i).span;
        if (monitor.formula == kNone) continue;
        monitor.truth = with_truths_of_lets(c, monitor.formula);
        check.measure(monitor);
        if (monitor.sliding)
            check.sliding(monitor, name);
        else
            check.prefix(monitor, name);
        if (monitor.duration) {
            check_duration(c, monitor);
            refuse_moving_thresholds(c, monitor, monitor.duration->threshold.span,
                                     "has a calibrated duration");
        }
        if (!monitor.calibration || moves_with_its_shift(c, monitor)) continue;
        refuse_moving_thresholds(c, monitor, monitor.calibration->span, "is calibrated as a whole");
        if (monitor.calibration->origin != ThresholdOrigin::normal)
            refuse_comparisons_without_truth(c, monitor);
    }
}

}  // namespace etlc::check
