// Faults that are planted in a plan, and whether an input shows them.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "execute/evaluator.hpp"
#include "prove/prove.hpp"
#include "proving.hpp"
#include "random.hpp"
#include "random_formula.hpp"
#include "random_trace.hpp"

namespace etlc::tests {

using Fault = std::function<void(plan::Plan&)>;

inline void change_interval(ir::Interval& interval, bool low, bool up) {
    std::uint32_t& end = low || !interval.bounded() ? interval.low : interval.high;
    if (up || end == 0)
        ++end;
    else
        --end;
}

/// Returns the faults that can be made of a plan without changing the size of the class.
inline std::vector<Fault> faults_of(const plan::Plan& plan) {
    using Op = plan::StreamOp;
    std::vector<Fault> faults;
    for (std::size_t s = 0; s < plan.streams.size(); ++s) {
        const Op op = plan.streams[s].op;
        if (op == Op::combination || op == Op::running || op == Op::window || op == Op::since)
            faults.emplace_back([s](plan::Plan& of) { of.streams[s].max = !of.streams[s].max; });
        for (const bool low : {true, false})
            if (op == Op::within)
                faults.emplace_back([s, low](plan::Plan& of) {
                    change_interval(of.streams[s].interval, low, true);
                });
    }
    for (std::size_t r = 0; r < plan.readings.size(); ++r) {
        const plan::Reading& reading = plan.readings[r];
        if (reading.kind == plan::Reading::Kind::combination)
            faults.emplace_back([r](plan::Plan& of) { of.readings[r].max = !of.readings[r].max; });
        for (std::size_t a = 0; a < reading.straight.assignments.size(); ++a)
            for (const bool low : {true, false})
                for (const bool up : {true, false}) {
                    // A local is assigned at every position.
                    if (reading.straight.assignments[a].target != plan::Term::Kind::reg) continue;
                    faults.emplace_back([=](plan::Plan& of) {
                        change_interval(of.readings[r].straight.assignments[a].positions, low, up);
                    });
                }
        for (std::size_t t = 0; t + 1 < reading.table.transitions.size(); ++t)
            faults.emplace_back([r, t](plan::Plan& of) {
                auto& transitions = of.readings[r].table.transitions;
                std::swap(transitions[t].guard, transitions[t + 1].guard);
            });
        for (std::size_t p = 0; p < reading.pending.parts.size(); ++p)
            faults.emplace_back([r, p](plan::Plan& of) {
                of.readings[r].pending.parts[p].max = !of.readings[r].pending.parts[p].max;
            });
    }
    return faults;
}

using Verdicts = std::vector<etlmon::Verdict>;

/// Whether verdicts differ. Bounds may be tighter than the definition's, unless they count.
inline bool differ(const Verdicts& a, const Verdicts& b, bool with_bounds) {
    for (std::size_t m = 0; m < a.size(); ++m) {
        const auto status = [&](const etlmon::Verdict& of) {
            return with_bounds ? of.status : of.status & ~std::uint32_t{etlmon::Verdict::kFinal};
        };
        if (status(a[m]) != status(b[m])) return true;
        if (!a[m].decided()) continue;
        if (a[m].robustness != b[m].robustness) return true;
        if (with_bounds && (a[m].lower != b[m].lower || a[m].upper != b[m].upper)) return true;
    }
    return false;
}

/// Whether two plans give other verdicts on some random trace.
inline bool differ(const plan::Plan& one, const plan::Plan& other, int traces,
                   std::uint32_t steps) {
    execute::Evaluator first(one), second(other);
    for (int n = 0; n < traces; ++n) {
        const auto trace = random_trace(*one.model, n, {.steps = steps, .missing = 0.1});
        first.reset();
        second.reset();
        for (const reference::Step& step : trace)
            if (differ(first.step(samples(step)), second.step(samples(step)), false)) return true;
    }
    return false;
}

/// Whether the input of a proof shows the fault: the inputs of predicates are numbers.
inline bool is_shown(const plan::Plan& right, const plan::Plan& wrong, const prove::Proof& proof) {
    const prove::Fault& fault = *proof.fault;
    execute::Evaluator first(right), second(wrong);
    bool shown = false;
    for (std::uint32_t step = 0; step <= fault.step; ++step) {
        std::vector<execute::Sample> inputs(right.model->inputs.size());
        for (std::size_t a = 0; a < proof.atoms.size(); ++a) {
            const prove::Atom& atom = proof.atoms[a];
            const auto& known = fault.witness.values[step][a];
            if (!known) continue;
            const auto* predicate =
                atom.is_predicate ? &right.model->predicates[atom.index] : nullptr;
            execute::Sample& sample = inputs[predicate ? predicate->inputs[0] : atom.index];
            sample.present = true;
            sample.values = {predicate ? prove::measured(*predicate, *known)
                                       : (*known > 0 ? 1.0F : 0.0F)};
        }
        shown = differ(first.step(inputs), second.step(inputs), true);
    }
    for (std::uint32_t call = 0; call < fault.finishes; ++call)
        shown = differ(first.finish(), second.finish(), true);
    return shown;
}

/// A spec whose predicates compare one number each.
inline std::string plain_spec(std::uint64_t seed) {
    Random random(seed);
    std::string text =
        "spec plain;\n"
        "input x0, x1 : f32 in [-2, 2];\n"
        "input x2 : f32;\n"
        "input on : bool;\n"
        "predicate p0 = x0 > 0.5;\n"
        "predicate p1 = x1 <= 0.25;\n"
        "predicate p2 = x2 >= 1 missing false;\n";
    const std::vector<std::string> atoms = {"p0", "p1", "p2", "on"};
    for (int m = 0; m < 3; ++m) {
        const bool sliding = random.chance(0.4);
        RandomFormula formulas(
            random, atoms, [&] { return random.word(atoms); },
            {.depth = 3, .window = 4, .unbounded = !sliding}, fmt::format("part{}_", m));
        const std::string formula = formulas.make();
        text += formulas.take_lets() +
                fmt::format("{}monitor m{} = {};\n", sliding ? "sliding " : "", m, formula);
    }
    return text;
}

}  // namespace etlc::tests
