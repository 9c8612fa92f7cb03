#include "explain/observations.hpp"

#include <algorithm>
#include <limits>

#include "etlmon/temporal/predicate.hpp"
#include "plan/program/value_type.hpp"

namespace etlc::explain {

namespace {

constexpr float kMissing = std::numeric_limits<float>::quiet_NaN();

plan::Plan plan_of(const check::Model& model, const std::vector<Index>& predicates,
                   const std::vector<Index>& inputs) {
    plan::Plan plan = plan::measuring(model, predicates);
    for (const Index input : inputs)
        if (model.inputs[input].type == check::InputType::boolean) plan.inputs.push_back(input);
    std::sort(plan.inputs.begin(), plan.inputs.end());
    return plan;
}

std::size_t place(const check::Model& model, const Atom& atom) {
    return atom.is_predicate ? model.predicates[atom.index].span.begin
                             : model.inputs[atom.index].span.begin;
}

}  // namespace

Observations::Observations(const check::Model& model, check::Values values,
                           const std::vector<Index>& predicates, const std::vector<Index>& inputs)
    : model_(model),
      values_(values),
      plan_(plan_of(model, predicates, inputs)),
      of_predicates_(model.predicates.size()),
      of_inputs_(model.inputs.size()) {
    for (Index p = 0; p < model.predicates.size(); ++p) atoms_.push_back({true, p});
    for (Index input = 0; input < model.inputs.size(); ++input)
        if (model.inputs[input].type == check::InputType::boolean) atoms_.push_back({false, input});
    std::stable_sort(atoms_.begin(), atoms_.end(), [&](const Atom& a, const Atom& b) {
        return place(model, a) < place(model, b);
    });
    for (Index a = 0; a < atoms_.size(); ++a)
        (atoms_[a].is_predicate ? of_predicates_ : of_inputs_)[atoms_[a].index] = a;
    columns_.resize(atoms_.size());
    for (Index a = 0; a < atoms_.size(); ++a) {
        if (!atoms_[a].is_predicate) continue;
        columns_[a].distances = check::measured_targets(model, model.predicates[atoms_[a].index]);
        columns_[a].nearest.resize(columns_[a].distances.size());
    }
    for (const Index p : predicates) columns_[of_predicates_[p]].is_looked_at = true;
    for (const Index input : plan_.inputs)
        if (model.inputs[input].type == check::InputType::boolean)
            columns_[of_inputs_[input]].is_looked_at = true;
}

Index Observations::atom(bool is_predicate, Index index) const {
    return is_predicate ? of_predicates_[index] : of_inputs_[index];
}

const check::Predicate& Observations::predicate(Index atom) const {
    return model_.predicates[atoms_[atom].index];
}

void Observations::add(const execute::Evaluator& evaluator) {
    for (Index a = 0; a < atoms_.size(); ++a) {
        const Atom& atom = atoms_[a];
        Column& column = columns_[a];
        if (atom.is_predicate) {
            column.measured.push_back(evaluator.distance(atom.index));
            for (std::size_t n = 0; n < column.distances.size(); ++n)
                column.nearest[n].push_back(evaluator.measured(column.distances[n]).nearest);
            continue;
        }
        const float* flag = evaluator.input(atom.index);
        column.measured.push_back(flag == nullptr ? kMissing : *flag);
    }
    ++steps_;
}

void Observations::reserve(std::uint64_t steps) {
    for (Column& column : columns_) {
        column.measured.reserve(steps);
        for (std::vector<std::uint32_t>& rows : column.nearest) rows.reserve(steps);
    }
}

void Observations::clear() {
    for (Column& column : columns_) {
        column.measured.clear();
        for (std::vector<std::uint32_t>& rows : column.nearest) rows.clear();
    }
    steps_ = 0;
}

void Observations::take(const Observations& other) {
    columns_ = other.columns_;
    steps_ = other.steps_;
}

bool Observations::fits(std::uint64_t steps) const {
    const auto is_whole = [&](const auto& numbers) { return numbers.size() == steps; };
    return steps_ == steps && std::all_of(columns_.begin(), columns_.end(), [&](const Column& c) {
               return is_whole(c.measured) &&
                      std::all_of(c.nearest.begin(), c.nearest.end(), is_whole);
           });
}

bool Observations::is_missing(Sample sample) const {
    return etlmon::is_nan(measured(sample));
}

bool Observations::is_between(Sample sample) const {
    if (!atoms_[sample.atom].is_predicate || is_missing(sample)) return false;
    const etlmon::Value found = value(sample);
    return predicate(sample.atom).threshold.inner && found.low < 0 && found.high >= 0;
}

etlmon::Value Observations::value(Index atom, float measured) const {
    if (atoms_[atom].is_predicate) {
        const check::Predicate& predicate = this->predicate(atom);
        return plan::value_of(predicate, measured, predicate.threshold.value, values_);
    }
    if (etlmon::is_nan(measured)) return plan::missing_value(model_.inputs[atoms_[atom].index]);
    return measured != 0 ? etlmon::kTrue : etlmon::kFalse;
}

etlmon::Value Observations::range(Index atom) const {
    if (atoms_[atom].is_predicate) return plan::unseen_range(predicate(atom), values_);
    return {etlmon::kBottom, etlmon::kTop};
}

}  // namespace etlc::explain
