#include "evaluate/subject.hpp"

#include <algorithm>
#include <utility>

#include "check/formulas/horizons.hpp"
#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"

namespace etlc::evaluate {

namespace {

using check::Formula;
using Kind = check::Formula::Kind;

bool is_eventually(const Formula& f) {
    return f.kind == Kind::eventually && f.low == 0 && f.high == check::kUnbounded;
}

/// Returns the distinct operands of a conjunction, or the formula itself.
std::vector<Index> conjuncts_of(const check::Model& model, Index formula) {
    std::vector<Index> conjuncts;
    std::vector<bool> seen(model.formulas.size());
    const auto collect = [&](const auto& self, Index at) -> void {
        if (seen[at]) return;
        seen[at] = true;
        const Formula& f = model.formulas[at];
        if (f.kind != Kind::conjunction) return conjuncts.push_back(at);
        for (const Index operand : f.operands) self(self, operand);
    };
    collect(collect, formula);
    return conjuncts;
}

/// Returns the conjuncts of each of a, b, ... in F (a && F (b && ...)); fewer than two for any
/// other formula.
std::vector<std::vector<Index>> stages_of(const check::Model& model,
                                          const std::vector<check::Reach>& reaches, Index formula) {
    std::vector<std::vector<Index>> stages;
    while (is_eventually(model.formulas[formula])) {
        std::vector<Index> conjuncts = conjuncts_of(model, model.formulas[formula].operands[0]);
        const auto in_present = [&](Index c) { return reaches[c].future == check::kNone; };
        const auto rest = std::stable_partition(conjuncts.begin(), conjuncts.end(), in_present);
        const auto further = conjuncts.end() - rest;
        if (further > 1 || (further == 1 && !is_eventually(model.formulas[*rest]))) return {};
        if (rest == conjuncts.begin()) return {};
        stages.emplace_back(conjuncts.begin(), rest);
        if (further == 0) return stages;
        formula = *rest;
    }
    return {};
}

Index append(check::Model& model, Kind kind, std::vector<Index> operands) {
    Formula formula;
    formula.kind = kind;
    formula.operands = std::move(operands);
    model.formulas.push_back(std::move(formula));
    return static_cast<Index>(model.formulas.size() - 1);
}

/// Adds a ground-truth monitor that tells whether the stage has been visited.
Index append_visit(check::Model& model, const std::string& name,
                   const std::vector<Index>& conjuncts) {
    const Index stage =
        conjuncts.size() == 1 ? conjuncts[0] : append(model, Kind::conjunction, conjuncts);
    check::Monitor monitor;
    monitor.name = name;
    monitor.formula = append(model, Kind::eventually, {stage});
    model.monitors.push_back(std::move(monitor));
    return static_cast<Index>(model.monitors.size() - 1);
}

}  // namespace

Subject subject(const check::Model& model, std::vector<Index> labelled) {
    Subject result{labelled, {}, episodes::ground_truth(model, labelled), {}};
    check::Model& truth = result.truth.model;
    const auto lacking_in = [&](Index formula) {
        std::vector<Index> lacking;
        for (const Index p : check::predicates_of(model, formula)) {
            const bool has_label = std::find(labelled.begin(), labelled.end(), p) != labelled.end();
            if (!has_label && !check::is_own_truth(model, p)) lacking.push_back(p);
        }
        return lacking;
    };
    for (Index l = 0; l < model.lets.size(); ++l) {
        const check::Let& let = model.lets[l];
        truth.lets[l].telemetry =
            let.telemetry && let.truth != check::kNone && lacking_in(let.truth).empty();
        if (truth.lets[l].telemetry) result.lets.push_back(l);
    }
    const std::vector<check::Monitor> true_monitors = std::exchange(truth.monitors, {});
    const std::vector<check::Reach> reaches = check::reaches(truth);
    for (Index m = 0; m < model.monitors.size(); ++m) {
        const check::Monitor& monitor = model.monitors[m];
        MonitorSubject& subject = result.monitors.emplace_back();
        subject.monitor = m;
        subject.lacking = lacking_in(monitor.true_formula());
        if (!subject.lacking.empty()) continue;
        subject.truth = static_cast<Index>(truth.monitors.size());
        truth.monitors.push_back(true_monitors[m]);
        const auto stages = stages_of(truth, reaches, true_monitors[m].formula);
        if (monitor.sliding || stages.size() < 2) continue;
        for (const auto& conjuncts : stages)
            subject.stages.push_back(append_visit(truth, monitor.name, conjuncts));
    }
    return result;
}

bool has_truths(const Subject& subject) {
    return !subject.labelled.empty() ||
           std::any_of(subject.monitors.begin(), subject.monitors.end(),
                       [](const MonitorSubject& monitor) { return monitor.lacking.empty(); });
}

}  // namespace etlc::evaluate
