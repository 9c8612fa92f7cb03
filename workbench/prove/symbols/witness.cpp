#include "prove/symbols/witness.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace etlc::prove {
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

/// Returns the first place of each sample.
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
        const Diagram missing = both(
            both(equal(low, number(range.lowest)), equal(negated_low, number(-range.lowest))),
            both(equal(high, number(range.highest)), equal(negated_high, number(-range.highest))));
        return either(both(same, known), missing);
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
        if (reached && place >= etlprove::kFirstNumber && place < kFirstSample)
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

}  // namespace

bool are_equal_in_ranges(Space& space, Diagram first, Diagram second,
                         const std::vector<Atom>& atoms) {
    Diagrams& diagrams = space.diagrams;
    Inputs inputs(space, atoms, true);
    Diagram differ = diagrams.differ(first, second);
    const std::set<Place> places = support(diagrams, differ);
    for (const Place first_end : samples_of(places))
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

std::optional<Witness> difference(Space& space, Diagram first, Diagram second,
                                  const std::vector<Atom>& atoms, std::uint32_t steps,
                                  std::uint32_t most_steps, bool may_be_missing, bool at_zero) {
    Diagrams& diagrams = space.diagrams;
    Diagram differ = diagrams.differ(first, second);
    if (differ == kNever) return std::nullopt;
    Inputs inputs(space, atoms, may_be_missing);
    const std::set<Place> samples = samples_of(support(diagrams, differ));
    Diagram conditions = kAlways;
    for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
        conditions = diagrams.both(inputs.sample(*sample, atom_of(*sample, atoms)), conditions);
    }
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
