#include "prove/symbols.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "reference/clauses.hpp"
#include "reference/explanation.hpp"

namespace etlc::prove {

namespace {

Atom atom_of(const check::Model& model, bool is_predicate, Index index) {
    reference::Unseen range{-reference::kInfinity, reference::kInfinity};
    std::optional<bool> missing;
    if (is_predicate) {
        range = {model.predicates[index].robustness.low, model.predicates[index].robustness.high};
        missing = model.predicates[index].missing;
    } else {
        missing = model.inputs[index].missing;
    }
    // "counts as false where it is missing": then it is known.
    const double said = missing.value_or(false) ? reference::kInfinity : -reference::kInfinity;
    const bool is_truth = !is_predicate || model.predicates[index].equality();
    Atom atom{is_predicate, index, true,
              is_truth,     false, missing ? reference::Unseen{said, said} : range,
              range};
    if (is_predicate) {
        atom.of_two = model.predicates[index].threshold.inner.has_value();
        atom.threshold = model.predicates[index].threshold.value;
    }
    return atom;
}

bool is_of(const reference::Node& node, const Atom& atom) {
    return node.is_atom() && node.index == atom.index &&
           atom.is_predicate == (node.kind == reference::Node::Kind::predicate);
}

/// The atoms by kind, predicates first, and index.
using Which = std::set<std::pair<int, Index>>;

}  // namespace

std::vector<Atom> atoms_of(const plan::Plan& plan) {
    Which read;
    for (const Index p : plan.predicates) read.emplace(0, p);
    for (const plan::Stream& stream : plan.streams)
        if (stream.op == plan::StreamOp::flag) read.emplace(1, stream.index);
    Which other;
    for (const reference::Node& node : reference::normal_form(*plan.model).nodes)
        if (node.is_atom())
            other.emplace(node.kind == reference::Node::Kind::predicate ? 0 : 1, node.index);
    std::vector<Atom> atoms;
    for (const auto& [kind, index] : read) atoms.push_back(atom_of(*plan.model, kind == 0, index));
    for (const auto& [kind, index] : other) {
        if (read.contains({kind, index})) continue;
        atoms.push_back(atom_of(*plan.model, kind == 0, index));
        atoms.back().is_read = false;
    }
    return atoms;
}

std::vector<Truths> truths_of(const plan::Plan& plan, const std::vector<Atom>& atoms) {
    std::vector<Truths> result;
    if (plan.values != check::Values::boolean) return result;
    const reference::NormalForm form = reference::normal_form(*plan.model);
    const reference::Literals ranges =
        reference::literals(*plan.model, form, {}, check::Values::boolean);
    for (const Atom& atom : atoms) {
        const bool is_declared = atom.is_predicate
                                     ? plan.model->predicates[atom.index].missing.has_value()
                                     : plan.model->inputs[atom.index].missing.has_value();
        result.push_back(is_declared && !atom.of_two ? Truths::known : Truths::any);
        for (std::size_t n = 0; n < form.nodes.size(); ++n) {
            if (!is_of(form.nodes[n], atom)) continue;
            reference::Unseen range = ranges.ranges[n];
            if (form.nodes[n].negated) range = reference::negate(range);
            if (range.lowest >= 0) result.back() = Truths::yes;
            if (range.highest < 0) result.back() = Truths::no;
        }
    }
    return result;
}

Definition::Definition(const plan::Plan& plan, const std::vector<Atom>& atoms,
                       const std::vector<Truths>& truths, std::uint32_t steps, bool missing)
    : plan_(plan), form_(reference::normal_form(*plan.model)), prefixes_(steps) {
    const reference::Literals ranges =
        reference::literals(*plan.model, form_, {},
                            truths.empty() ? check::Values::robustness : check::Values::boolean);
    literals_.values.resize(form_.nodes.size());
    literals_.ranges.resize(form_.nodes.size());
    for (std::size_t n = 0; n < form_.nodes.size(); ++n) {
        const reference::Node& node = form_.nodes[n];
        if (!node.is_atom()) continue;
        const auto atom = std::find_if(atoms.begin(), atoms.end(),
                                       [&](const Atom& one) { return is_of(node, one); });
        literals_.ranges[n] = {ranges.ranges[n].lowest, ranges.ranges[n].highest};
        const auto at = static_cast<std::size_t>(atom - atoms.begin());
        for (std::uint32_t step = 0; step < steps; ++step) {
            const Place sample = etlprove::place_of({step, steps}, at, atoms.size(), 0);
            literals_.values[n].push_back(truths.empty() ? number(sample, node.negated, missing)
                                                         : truth(truths[at], sample, node.negated));
        }
    }
}

Definition::Literal Definition::number(Place sample, bool negated, bool missing) {
    const Place high = missing ? etlprove::kHigh : etlprove::kLow;
    const Place negated_high = missing ? etlprove::kNegatedHigh : etlprove::kNegatedLow;
    const Symbol low = Symbol::variable(sample + (negated ? negated_high : etlprove::kLow));
    const Symbol up = Symbol::variable(sample + (negated ? etlprove::kNegatedLow : high));
    return {low, low, up, up};
}

Definition::Literal Definition::truth(Truths truths, Place sample, bool negated) {
    const etlprove::Ends ends = Symbol::ends_of(truths, sample);
    const Symbol low = Symbol::of(ends.low), high = Symbol::of(ends.high);
    if (negated) return {-high, -high, -low, -low};
    return {low, low, high, high};
}

Numbers Definition::verdict(std::uint32_t monitor, std::uint32_t end, std::uint32_t position) {
    auto& prefix = prefixes_[end];
    if (!prefix) prefix = std::make_unique<reference::PrefixOf<Symbol>>(form_, literals_, end);
    const plan::Monitor& of = plan_.monitors[monitor];
    const Literal value = prefix->at(form_.roots[of.index], position);
    const Diagram low = value.rho.diagram(), high = value.rho_high.diagram();
    // "A sliding verdict has lower = rho, upper = rho_high"
    if (of.sliding) return {true, low, high, low, high};
    return {true, low, high, value.lower.diagram(), value.upper.diagram()};
}

namespace {

using etlprove::Diagrams;
using etlprove::kAlways;
using etlprove::kFirstSample;
using etlprove::kNever;
using etlprove::kPlacesPerSample;

/// Returns the variables that a function depends on.
std::set<Place> support(const Diagrams& diagrams, Diagram of) {
    std::set<Place> places;
    std::set<Diagram> seen;
    std::vector<Diagram> open{of};
    while (!open.empty()) {
        const Diagram at = open.back();
        open.pop_back();
        if (at <= kAlways || !seen.insert(at).second) continue;
        places.insert(diagrams[at].place);
        open.push_back(diagrams[at].without);
        open.push_back(diagrams[at].with);
    }
    return places;
}

std::set<Place> samples_of(const std::set<Place>& places) {
    std::set<Place> samples;
    for (const Place place : places)
        if (place >= kFirstSample)
            samples.insert(place - (place - kFirstSample) % kPlacesPerSample);
    return samples;
}

std::size_t atom_of(Place sample, const std::vector<Atom>& atoms) {
    return (sample - kFirstSample) / kPlacesPerSample % atoms.size();
}

/// The conditions that inputs meet, as functions.
class Inputs {
public:
    Inputs(Space& space, const std::vector<Atom>& atoms, bool may_be_missing)
        : space_(space), atoms_(atoms), may_be_missing_(may_be_missing) {}

    /// 0 reaches the threshold, and the number before it does not.
    Diagram threshold_is_zero() {
        const std::vector<float>& all = space_.numbers.all();
        const auto zero = std::find(all.begin(), all.end(), 0.0F);
        return zero == all.begin() ? number(0) : both(number(0), no(number(*(zero - 1))));
    }

    Diagram sample(Place first, std::size_t atom) {
        const Diagram low = variable(first + etlprove::kLow);
        const Diagram negated_low = variable(first + etlprove::kNegatedLow);
        const Diagram known = known_sample(low, negated_low, atoms_[atom]);
        if (!may_be_missing_) return known;
        const Diagram high = variable(first + etlprove::kHigh);
        const Diagram negated_high = variable(first + etlprove::kNegatedHigh);
        const reference::Unseen& range = atoms_[atom].missing;
        const Diagram same = both(equal(low, high), equal(negated_low, negated_high));
        const Diagram in_order = both(implies(low, high), implies(negated_high, negated_low));
        const Diagram between =
            atoms_[atom].of_two
                ? both(in_order, both(known, known_sample(high, negated_high, atoms_[atom])))
                : etlprove::kNever;
        const Diagram missing = both(
            both(equal(low, number(range.lowest)), equal(negated_low, number(-range.lowest))),
            both(equal(high, number(range.highest)), equal(negated_high, number(-range.highest))));
        return either(either(both(same, known), missing), between);
    }

    /// Each end is in the range of numbers and of what a missing sample may be.
    Diagram ends(Place first, std::size_t atom) {
        const Atom& of = atoms_[atom];
        const double lowest = std::min(of.range.lowest, of.missing.lowest);
        const double highest = std::max(of.range.highest, of.missing.highest);
        Diagram result = etlprove::kAlways;
        for (const Place end : {etlprove::kLow, etlprove::kHigh})
            result = both(result, both(within(variable(first + end), lowest, highest),
                                       within(variable(first + end + 1), -highest, -lowest)));
        return result;
    }

private:
    Diagram within(Diagram value, double lowest, double highest) {
        return both(implies(value, number(highest)), implies(number(lowest), value));
    }
    Diagram variable(Place place) { return space_.diagrams.variable(place); }
    Diagram number(double x) { return space_.at_least(static_cast<float>(x)); }
    Diagram both(Diagram a, Diagram b) { return space_.diagrams.both(a, b); }
    Diagram either(Diagram a, Diagram b) { return space_.diagrams.either(a, b); }
    Diagram no(Diagram a) { return space_.diagrams.complement(a); }
    Diagram implies(Diagram a, Diagram b) { return either(no(a), b); }
    Diagram equal(Diagram a, Diagram b) { return no(space_.diagrams.differ(a, b)); }

    /// Whether a number x is at least the threshold t, and -x. If t > 0 only one can be, else at
    /// least one is.
    Diagram known_sample(Diagram value, Diagram negated, const Atom& atom) {
        if (atom.is_truth) return equal(value, no(negated));
        const Diagram sign = either(both(no(number(0)), no(both(value, negated))),
                                    both(number(0), either(value, negated)));
        return both(both(sign, within(value, atom.range.lowest, atom.range.highest)),
                    within(negated, -atom.range.highest, -atom.range.lowest));
    }

    Space& space_;
    const std::vector<Atom>& atoms_;
    bool may_be_missing_;
};

/// Returns the variables of a way through the diagram that ends in kAlways.
std::map<Place, bool> way(const Diagrams& diagrams, Diagram of) {
    std::map<Place, bool> result;
    while (of != kAlways) {
        const Diagrams::Node node = diagrams[of];
        const bool with = node.without == kNever;
        result[node.place] = with;
        of = with ? node.with : node.without;
    }
    return result;
}

/// Returns whether a function is true where these variables are, and no others.
bool holds(const Diagrams& diagrams, Diagram of, const std::map<Place, bool>& variables) {
    while (of > kAlways) {
        const auto found = variables.find(diagrams[of].place);
        of = found != variables.end() && found->second ? diagrams[of].with : diagrams[of].without;
    }
    return of == kAlways;
}

/// Returns a threshold: the first number that reaches it, or one that is above all.
float threshold_of(const etlprove::Numbers& numbers, const std::map<Place, bool>& variables) {
    for (const auto& [place, reached] : variables)
        if (reached && place >= etlprove::kFirstNumber && place < etlprove::kFirstLeft)
            return numbers[place];
    return numbers.all().back() + 1;
}

/// Returns a number x in the range with x >= threshold and -x >= threshold as said.
float number_of(float threshold, bool reached, bool negated_reached, const Atom& atom) {
    const float least = static_cast<float>(atom.range.lowest);
    const float greatest = static_cast<float>(atom.range.highest);
    if (atom.is_truth) return reached ? INFINITY : -INFINITY;
    float x = 0;
    if (reached && !negated_reached) x = threshold > 0 ? threshold : 1 - threshold;
    if (!reached && negated_reached) x = threshold > 0 ? -threshold : threshold - 1;
    return std::clamp(x, least, greatest);
}

/// Returns a robustness of an atom that is true, or false, in its range and as far from the
/// threshold as there is room, so that it is not rounded to it.
float robustness_of(const Atom& atom, bool truth) {
    if (atom.is_truth) return truth ? INFINITY : -INFINITY;
    const float far = std::max(1.0F, std::abs(atom.threshold));
    return std::clamp(truth ? far : -far, static_cast<float>(atom.range.lowest),
                      static_cast<float>(atom.range.highest));
}

}  // namespace

bool are_equal_in_ranges(Space& space, Diagram first, Diagram second,
                         const std::vector<Atom>& atoms) {
    Diagrams& diagrams = space.diagrams;
    Inputs inputs(space, atoms, true);
    Diagram differ = diagrams.differ(first, second);
    for (const Place first_end : samples_of(support(diagrams, differ)))
        differ = diagrams.both(differ, inputs.ends(first_end, atom_of(first_end, atoms)));
    return differ == kNever;
}

std::set<std::vector<std::uint16_t>> ends_in_ranges(Space& space, const std::vector<Atom>& atoms) {
    Inputs inputs(space, atoms, true);
    std::vector<Diagram> conditions;
    for (std::size_t a = 0; a < atoms.size(); ++a)
        conditions.push_back(inputs.ends(kFirstSample, a));
    std::set<std::vector<std::uint16_t>> result;
    // The first number that reaches the threshold, or none.
    const auto numbers = static_cast<Place>(space.numbers.all().size());
    for (Place n = 0; n <= numbers; ++n) {
        std::vector<std::uint16_t> possible(atoms.size(), 0);
        for (std::uint32_t ends = 0; ends < 1U << kPlacesPerSample; ++ends) {
            std::map<Place, bool> variables;
            if (n < numbers) variables[etlprove::kFirstNumber + n] = true;
            for (Place end = 0; end < kPlacesPerSample; ++end)
                variables[kFirstSample + end] = (ends >> end & 1U) != 0;
            for (std::size_t a = 0; a < atoms.size(); ++a)
                if (holds(space.diagrams, conditions[a], variables))
                    possible[a] = static_cast<std::uint16_t>(possible[a] | 1U << ends);
        }
        result.insert(possible);
    }
    return result;
}

Witness truths_where(const Diagrams& diagrams, Diagram condition, const std::vector<Atom>& atoms,
                     const std::vector<Truths>& truths, std::uint32_t steps,
                     std::uint32_t most_steps) {
    std::map<Place, bool> chosen;
    while (condition > kAlways) {  // a known sample, where there is a choice
        const Diagrams::Node node = diagrams[condition];
        const bool is_low = node.place >= kFirstSample &&
                            (node.place - kFirstSample) % kPlacesPerSample == etlprove::kLow;
        const bool with = is_low ? node.with != kNever : node.without == kNever;
        chosen[node.place] = with;
        condition = with ? node.with : node.without;
    }
    const auto is = [&](Place place, bool otherwise) {
        const auto found = chosen.find(place);
        return found == chosen.end() ? otherwise : found->second;
    };
    Witness witness;
    for (std::uint32_t step = 0; step < steps; ++step) {
        witness.values.emplace_back();
        for (std::size_t a = 0; a < atoms.size(); ++a) {
            const Place at = etlprove::place_of({step, most_steps}, a, atoms.size(), 0);
            const bool high = truths[a] == Truths::yes ||
                              (truths[a] != Truths::no && is(at + etlprove::kHigh, false));
            const bool low =
                truths[a] == Truths::any ? high && is(at + etlprove::kLow, true) : high;
            std::optional<float> value;
            if (low) value = robustness_of(atoms[a], true);
            if (!high) value = robustness_of(atoms[a], false);
            witness.values.back().push_back(value);
        }
    }
    return witness;
}

std::optional<Witness> difference(Space& space, Diagram first, Diagram second,
                                  const std::vector<Atom>& atoms, std::uint32_t steps,
                                  std::uint32_t most_steps, bool may_be_missing, bool at_zero) {
    Diagrams& diagrams = space.diagrams;
    Diagram differ = diagrams.differ(first, second);
    if (differ == kNever) return std::nullopt;
    Inputs inputs(space, atoms, may_be_missing);
    const std::set<Place> samples = samples_of(support(diagrams, differ));
    Diagram conditions = kAlways;
    for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample)
        conditions = diagrams.both(inputs.sample(*sample, atom_of(*sample, atoms)), conditions);
    if (at_zero) conditions = diagrams.both(conditions, inputs.threshold_is_zero());
    differ = diagrams.both(differ, conditions);
    if (differ == kNever) return std::nullopt;

    const std::map<Place, bool> variables = way(diagrams, differ);
    Witness witness;
    witness.threshold = threshold_of(space.numbers, variables);
    witness.first_reaches = holds(diagrams, first, variables);
    const auto is = [&](Place place) {
        const auto found = variables.find(place);
        return found != variables.end() && found->second;
    };
    for (std::uint32_t step = 0; step < steps; ++step) {
        witness.values.emplace_back();
        for (std::size_t a = 0; a < atoms.size(); ++a) {
            const Place at = etlprove::place_of({step, most_steps}, a, atoms.size(), 0);
            const bool low = is(at + etlprove::kLow), high = is(at + etlprove::kHigh);
            const bool negated_low = is(at + etlprove::kNegatedLow);
            const bool same = !may_be_missing || !samples.contains(at) ||
                              (low == high && negated_low == is(at + etlprove::kNegatedHigh));
            std::optional<float> value;
            if (!samples.contains(at))
                value = number_of(0, true, !atoms[a].is_truth, atoms[a]);
            else if (same)
                value = number_of(witness.threshold, low, negated_low, atoms[a]);
            witness.values.back().push_back(value);
        }
    }
    return witness;
}

}  // namespace etlc::prove
