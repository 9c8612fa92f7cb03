#include "check/formulas/horizons.hpp"

#include <algorithm>
#include <set>

#include "check/points/project.hpp"

namespace etlc::check {

namespace {

constexpr std::uint64_t kSaturated = std::uint64_t{1} << 60U;

void take_first(Index& mine, Index operands) {
    if (mine == kNone) mine = operands;
}

/// Inputs that may leave a formula unknown, and how many steps back it reads.
struct Reading {
    std::set<Index> inputs;
    std::uint64_t back = 0;
};

std::set<Index> inputs_of(const Model& model, const Formula& atom) {
    if (atom.kind == Formula::Kind::boolean_input && !model.inputs[atom.index].missing)
        return {atom.index};
    if (atom.kind != Formula::Kind::predicate || model.predicates[atom.index].missing) return {};
    const std::vector<Index>& inputs = model.predicates[atom.index].inputs;
    return {inputs.begin(), inputs.end()};
}

std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
    return a == Gap::kForGood || b == Gap::kForGood ? Gap::kForGood : a + b;
}

/// Returns how many steps back an expression reads.
std::uint64_t steps_back(const Model& model, const Expr& expression) {
    std::uint64_t back = 0;
    for (const Expr& argument : expression.arguments)
        back = std::max(back, steps_back(model, argument));
    if (expression.kind == Expr::Kind::distance) {
        const Distance& distance = model.distances[expression.index];
        back = longest_delay(model, distance.point);
        if (distance.is_between_points())
            back = std::max<std::uint64_t>(back, longest_delay(model, distance.other));
    }
    if (expression.kind != Expr::Kind::past) return back;
    const Past& past = model.pasts[expression.index];
    return back + past.steps - (past.kind == Past::Kind::ago ? 0 : 1);
}

std::vector<Reading> readings(const Model& model) {
    std::vector<Reading> result(model.formulas.size());
    for (Index f = 0; f < model.formulas.size(); ++f) {  // operands come first
        const Formula& formula = model.formulas[f];
        Reading& reading = result[f];
        reading.inputs = inputs_of(model, formula);
        if (formula.kind == Formula::Kind::predicate)
            reading.back = steps_back(model, model.predicates[formula.index].expression);
        for (const Index operand : formula.operands) {
            reading.inputs.insert(result[operand].inputs.begin(), result[operand].inputs.end());
            reading.back = std::max(reading.back, result[operand].back);
        }
        if (looks_back(formula.kind))
            reading.back =
                sum(reading.back,
                    steps_back(formula) == kUnbounded ? Gap::kForGood : steps_back(formula));
    }
    return result;
}

}  // namespace

std::vector<Reach> reaches(const Model& model) {
    std::vector<Reach> result(model.formulas.size());
    for (Index i = 0; i < model.formulas.size(); ++i) {
        const Formula& formula = model.formulas[i];
        Reach& reach = result[i];
        if (looks_ahead(formula.kind)) {
            reach.future = i;
            if (formula.high == kUnbounded) reach.unbounded = i;
        }
        for (const Index operand : formula.operands) {
            const Reach& below = result[operand];
            reach.horizon = std::max(reach.horizon, below.horizon);
            if (looks_back(formula.kind) && below.future != kNone)
                take_first(reach.past_over_future, i);
            take_first(reach.future, below.future);
            take_first(reach.unbounded, below.unbounded);
            take_first(reach.past_over_future, below.past_over_future);
        }
        if (looks_ahead(formula.kind) && formula.high != kUnbounded)
            reach.horizon = std::min(kSaturated, reach.horizon + formula.high);
    }
    return result;
}

std::vector<Gap> gaps(const Model& model) {
    const std::vector<Reading> all = readings(model);
    std::vector<Gap> result;
    for (const Monitor& monitor : model.monitors) {
        const Reading& reading = all[monitor.formula];
        // A prefix monitor stays at one position, whose sample is lost.
        const std::uint64_t steps =
            monitor.sliding ? sum(reading.back, monitor.horizon + std::uint64_t{1}) : Gap::kForGood;
        result.push_back({{reading.inputs.begin(), reading.inputs.end()}, steps});
    }
    return result;
}

}  // namespace etlc::check
