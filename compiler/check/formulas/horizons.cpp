#include "check/formulas/horizons.hpp"

#include <algorithm>
#include <set>

#include "check/points/points.hpp"

namespace etlc::check {

namespace {

constexpr std::uint64_t kSaturated = std::uint64_t{1} << 60U;

void take_first(Index& mine, Index operands) {
    if (mine == kNone) mine = operands;
}

/// Inputs that may leave a formula unknown, and how many steps back it reads.
struct Dependence {
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

std::vector<Dependence> dependences(const Model& model) {
    std::vector<Dependence> result(model.formulas.size());
    for (Index f = 0; f < model.formulas.size(); ++f) {  // operands come first
        const Formula& formula = model.formulas[f];
        Dependence& dependence = result[f];
        dependence.inputs = inputs_of(model, formula);
        if (formula.kind == Formula::Kind::predicate)
            dependence.back = steps_back(model, model.predicates[formula.index].expression);
        for (const Index operand : formula.operands) {
            dependence.inputs.insert(result[operand].inputs.begin(), result[operand].inputs.end());
            dependence.back = std::max(dependence.back, result[operand].back);
        }
        if (looks_back(formula.kind))
            dependence.back =
                sum(dependence.back,
                    steps_back(formula) == kUnbounded ? Gap::kForGood : steps_back(formula));
    }
    return result;
}

constexpr std::uint64_t kNever = Decidable::kNever;

std::uint64_t later(std::uint64_t position, std::uint64_t steps) {
    return position == kNever ? kNever : position + steps;
}

/// Returns from where on some position of [k, k + steps] is at `position` or behind it.
std::uint64_t earlier(std::uint64_t position, std::uint32_t steps) {
    if (position == kNever) return kNever;
    return steps == kUnbounded || position < steps ? 0 : position - steps;
}

Decidable negation(Decidable f) {
    return {f.violated, f.satisfied};
}

Decidable both(Decidable f, Decidable g) {
    return {std::max(f.satisfied, g.satisfied), std::min(f.violated, g.violated)};
}

Decidable either(Decidable f, Decidable g) {
    return negation(both(negation(f), negation(g)));
}

Decidable equivalence(Decidable f, Decidable g) {
    return {std::min(std::max(f.satisfied, g.satisfied), std::max(f.violated, g.violated)),
            std::min(std::max(f.satisfied, g.violated), std::max(f.violated, g.satisfied))};
}

/// Combines what is known of operands over a window.
struct Windows {
    Lasts lasts;
    std::uint32_t low;
    std::uint32_t high;

    /// G without an end holds for good at no step.
    Decidable always(Decidable f) const {
        const bool never = high == kUnbounded && lasts == Lasts::for_good;
        return {never ? kNever : earlier(f.satisfied, low), earlier(f.violated, high)};
    }

    /// f U g: g holds later than now, and f until then. It fails if g fails throughout, or until f
    /// does.
    Decidable until(Decidable f, Decidable g) const {
        const bool never = high == kUnbounded && lasts == Lasts::for_good;
        const std::uint64_t throughout = earlier(g.violated, low);
        std::uint64_t violated = std::max(throughout, earlier(f.violated, high));
        if (low > 0) violated = std::min(violated, earlier(f.violated, low - 1));
        if (!never) violated = std::min(violated, throughout);
        const std::uint64_t satisfied = earlier(g.satisfied, high);
        return {high == 0 ? g.satisfied : std::max(f.satisfied, satisfied), violated};
    }

    Decidable release(Decidable f, Decidable g) const {
        return negation(until(negation(f), negation(g)));
    }

    Decidable weak_until(Decidable f, Decidable g) const {
        return {std::min(always(f).satisfied, until(f, g).satisfied),
                release(g, either(f, g)).violated};
    }

    /// O f fails where all of its window is known.
    Decidable once(Decidable f) const {
        const bool never = f.violated > 0 && high == kUnbounded;
        return {later(f.satisfied, low), never             ? kNever
                                         : f.violated == 0 ? 0
                                                           : later(f.violated, high)};
    }

    Decidable since(Decidable f, Decidable g) const {
        const Decidable some = once(g);
        return {some.satisfied, std::min(some.violated, std::max(f.violated, g.violated))};
    }

    Decidable historically(Decidable f) const { return negation(once(negation(f))); }
};

/// rise f, or fall f of the negation, which fail at the first position whatever f is.
Decidable rise(Decidable f) {
    return {both(f, Windows{Lasts::so_far, 1, 1}.once(negation(f))).satisfied, 0};
}

/// held[n] f fails at the first n positions.
Decidable held(Decidable f, std::uint32_t n) {
    const std::uint64_t all = Windows{Lasts::so_far, 0, n}.historically(f).satisfied;
    return {std::max<std::uint64_t>(all, n), n == 0 ? f.violated : 0};
}

/// f at n of the positions of [0, high], which fails where there are fewer.
Decidable at_least(Decidable f, std::uint32_t n, std::uint32_t high) {
    if (n == 1) return Windows{Lasts::so_far, 0, high}.once(f);
    return {later(f.satisfied, n - 1), 0};
}

Decidable of_predicate(const Model& model, const Predicate& predicate) {
    const std::uint64_t from = past_needed(model, predicate);
    return {predicate.missing == true ? 0 : from, predicate.missing == false ? 0 : from};
}

Decidable decidable(const Formula& formula, const std::vector<Decidable>& f, Lasts lasts) {
    using Kind = Formula::Kind;
    const Windows in{lasts, formula.low, formula.high};
    switch (formula.kind) {
        case Kind::constant_true: return {0, kNever};
        case Kind::constant_false: return {kNever, 0};
        case Kind::predicate:
        case Kind::boolean_input: return {};
        case Kind::negation: return negation(f[0]);
        case Kind::conjunction:
        case Kind::disjunction: {
            Decidable all = f[0];
            for (const Decidable& one : f)
                all = formula.kind == Kind::conjunction ? both(all, one) : either(all, one);
            return all;
        }
        case Kind::implication: return either(negation(f[0]), f[1]);
        case Kind::equivalence: return equivalence(f[0], f[1]);
        case Kind::always: return in.always(f[0]);
        case Kind::next:
        case Kind::eventually: return negation(in.always(negation(f[0])));
        case Kind::until: return in.until(f[0], f[1]);
        case Kind::release: return in.release(f[0], f[1]);
        case Kind::weak_until: return in.weak_until(f[0], f[1]);
        case Kind::previous:
        case Kind::once:
        case Kind::historically:
        case Kind::since:
            if (formula.low > 0) return {};  // at the first positions its window is empty
            return formula.kind == Kind::since          ? in.since(f[0], f[1])
                   : formula.kind == Kind::historically ? in.historically(f[0])
                                                        : in.once(f[0]);
        case Kind::rise: return rise(f[0]);
        case Kind::fall: return rise(negation(f[0]));
        case Kind::held: return held(f[0], formula.high);
        case Kind::count:
            return formula.each_step ? at_least(f[0], formula.index, formula.high)
                                     : rise(f[0]);  // once or more
    }
    return {};
}

}  // namespace

std::uint64_t steps_read_back(const Model& model, Index formula) {
    return dependences(model)[formula].back;
}

std::uint64_t past_needed(const Model& model, const Predicate& predicate) {
    const bool decided = predicate.robustness.low >= 0 || predicate.robustness.high < 0;
    return decided ? 0 : steps_back(model, predicate.expression);
}

std::vector<Decidable> decidable(const Model& model, Lasts lasts, bool reads_past) {
    std::vector<Decidable> result;
    result.reserve(model.formulas.size());
    std::vector<Decidable> operands;
    for (const Formula& formula : model.formulas) {
        operands.clear();
        for (const Index operand : formula.operands) operands.push_back(result[operand]);
        result.push_back(formula.kind == Formula::Kind::predicate && reads_past
                             ? of_predicate(model, model.predicates[formula.index])
                             : decidable(formula, operands, lasts));
    }
    return result;
}

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
    const std::vector<Dependence> all = dependences(model);
    std::vector<Gap> result;
    for (const Monitor& monitor : model.monitors) {
        const Dependence& dependence = all[monitor.formula];
        // A prefix monitor stays at one position, whose sample is lost.
        const std::uint64_t steps = monitor.sliding
                                        ? sum(dependence.back, monitor.horizon + std::uint64_t{1})
                                        : Gap::kForGood;
        result.push_back({{dependence.inputs.begin(), dependence.inputs.end()}, steps});
    }
    return result;
}

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
            if (formula.each_step) return some(operands[0], formula.index == 1);
            return operands[0] == varies ? varies : never;
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
    if (formula.kind == Kind::count)
        return formula.each_step && formula.index == 1 ? operands[0] : never;
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
