#include "check/formulas/gaps.hpp"

#include <algorithm>
#include <set>

#include "check/formulas/looks.hpp"

namespace etlc::check {

namespace {

using Kind = Formula::Kind;

/// What one formula reads: inputs that may leave it unknown, and how many steps back.
struct Reading {
    std::set<Index> inputs;
    std::uint64_t back = 0;
};

std::set<Index> inputs_of(const Model& model, const Formula& atom) {
    if (atom.kind == Kind::boolean_input && !model.inputs[atom.index].missing) return {atom.index};
    if (atom.kind != Kind::predicate || model.predicates[atom.index].missing) return {};
    const std::vector<Index>& inputs = model.predicates[atom.index].inputs;
    return {inputs.begin(), inputs.end()};
}

std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
    return a == Gap::kForGood || b == Gap::kForGood ? Gap::kForGood : a + b;
}

std::vector<Reading> readings(const Model& model) {
    std::vector<Reading> result(model.formulas.size());
    for (Index f = 0; f < model.formulas.size(); ++f) {  // operands come first
        const Formula& formula = model.formulas[f];
        Reading& reading = result[f];
        reading.inputs = inputs_of(model, formula);
        for (const Index operand : formula.operands) {
            reading.inputs.insert(result[operand].inputs.begin(), result[operand].inputs.end());
            reading.back = std::max(reading.back, result[operand].back);
        }
        if (looks_back(formula.kind))
            reading.back =
                sum(reading.back, formula.high == kUnbounded ? Gap::kForGood : formula.high);
    }
    return result;
}

}  // namespace

std::vector<Gap> gaps(const Model& model) {
    const std::vector<Reading> all = readings(model);
    std::vector<Gap> result;
    for (const Monitor& monitor : model.monitors) {
        const Reading& reading = all[monitor.formula];
        // A prefix monitor goes on to speak of one position, which has lost its sample.
        const std::uint64_t steps =
            monitor.sliding ? sum(reading.back, monitor.horizon + std::uint64_t{1}) : Gap::kForGood;
        result.push_back({{reading.inputs.begin(), reading.inputs.end()}, steps});
    }
    return result;
}

}  // namespace etlc::check
