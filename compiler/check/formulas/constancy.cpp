#include "check/formulas/constancy.hpp"

#include <algorithm>

namespace etlc::check {

namespace {

using Kind = Formula::Kind;
using enum Constancy;

using Operands = std::vector<Constancy>;

Constancy negation(Constancy a) {
    return a == varies ? varies : a == always ? never : always;
}

/// Combines operands of && or ||, of which `deciding` decides alone, as `never` does for &&.
Constancy combine(const Operands& operands, Constancy deciding) {
    const auto is = [](Constancy value) {
        return [value](Constancy operand) { return operand == value; };
    };
    if (std::any_of(operands.begin(), operands.end(), is(deciding))) return deciding;
    const Constancy other = negation(deciding);
    return std::all_of(operands.begin(), operands.end(), is(other)) ? other : varies;
}

/// F and O fail without an operand that holds; a window that contains the present is never empty.
Constancy some(Constancy operand, bool holds_present) {
    if (operand == never) return never;
    return operand == always && holds_present ? always : varies;
}

/// G and H are the duals.
Constancy every(Constancy operand, bool holds_present) {
    return negation(some(negation(operand), holds_present));
}

/// U and S need the left operand if the right one cannot hold in the present.
Constancy until(Constancy left, Constancy right, bool holds_present) {
    if (right == never || (left == never && !holds_present)) return never;
    return right == always && holds_present ? always : varies;
}

Constancy release(Constancy left, Constancy right, bool holds_present) {
    return negation(until(negation(left), negation(right), holds_present));
}

Constancy of(const Formula& formula, const Operands& operands) {
    const bool present = formula.low == 0;
    switch (formula.kind) {
        case Kind::constant_true: return always;
        case Kind::constant_false: return never;
        case Kind::predicate:
        case Kind::boolean_input: return varies;
        case Kind::negation: return negation(operands[0]);
        case Kind::conjunction: return combine(operands, never);
        case Kind::disjunction: return combine(operands, always);
        case Kind::implication: return combine({negation(operands[0]), operands[1]}, always);
        case Kind::equivalence:
            if (operands[0] == varies || operands[1] == varies) return varies;
            return operands[0] == operands[1] ? always : never;
        case Kind::next:
        case Kind::previous:
        case Kind::eventually:
        case Kind::once: return some(operands[0], present);
        case Kind::count:
        case Kind::rise:
        case Kind::fall: return operands[0] == varies ? varies : never;
        case Kind::held: return operands[0] == never || formula.high == 0 ? operands[0] : varies;
        case Kind::always:
        case Kind::historically: return every(operands[0], present);
        case Kind::until:
        case Kind::since: return until(operands[0], operands[1], present);
        case Kind::release: return release(operands[0], operands[1], present);
        case Kind::weak_until: return release(operands[1], combine(operands, always), present);
    }
    return varies;
}

/// At position 0 past operators see only that position, or nothing.
Constancy past_at_start(const Formula& formula, const Operands& operands) {
    if (formula.kind == Kind::count) return never;
    if (formula.kind == Kind::held) return formula.high == 0 ? operands[0] : never;
    if (formula.low == 0) return operands.back();
    return formula.kind == Kind::historically ? always : never;
}

}  // namespace

std::vector<Constancies> constancies(const Model& model) {
    std::vector<Constancies> result(model.formulas.size());
    Operands anywhere, at_start;
    for (std::size_t i = 0; i < model.formulas.size(); ++i) {
        const Formula& formula = model.formulas[i];
        anywhere.clear();
        at_start.clear();
        for (const Index operand : formula.operands) {
            anywhere.push_back(result[operand].anywhere);
            at_start.push_back(result[operand].at_start);
        }
        result[i].anywhere = of(formula, anywhere);
        if (looks_back(formula.kind))
            result[i].at_start = past_at_start(formula, at_start);
        else if (looks_ahead(formula.kind))
            result[i].at_start = result[i].anywhere;
        else
            result[i].at_start = of(formula, at_start);
    }
    return result;
}

}  // namespace etlc::check
