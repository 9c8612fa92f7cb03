#include "prove/boolean_definition.hpp"

#include <algorithm>

#include "reference/clauses.hpp"
#include "reference/explanation.hpp"

namespace etlc::prove {
namespace {

bool is_of(const reference::Node& node, const Atom& atom) {
    return node.is_atom() && node.index == atom.index &&
           atom.is_predicate == (node.kind == reference::Node::Kind::predicate);
}

reference::Literals ranges_of(const plan::Plan& plan, const reference::NormalForm& form) {
    return reference::literals(*plan.model, form, {}, check::Values::boolean);
}

}  // namespace

std::vector<Truths> truths_of(const plan::Plan& plan, const std::vector<Atom>& atoms) {
    const reference::NormalForm form = reference::normal_form(*plan.model);
    const reference::Literals ranges = ranges_of(plan, form);
    std::vector<Truths> result;
    for (const Atom& atom : atoms) {
        const bool is_declared = atom.is_predicate
                                     ? plan.model->predicates[atom.index].missing.has_value()
                                     : plan.model->inputs[atom.index].missing.has_value();
        result.push_back(is_declared ? Truths::known : Truths::any);
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

BooleanDefinition::BooleanDefinition(const plan::Plan& plan, const std::vector<Atom>& atoms,
                                     const std::vector<Truths>& truths, Space& space,
                                     const etlprove::TruthPlaces& places)
    : plan_(plan), form_(reference::normal_form(*plan.model)), prefixes_(places.steps) {
    const reference::Literals ranges = ranges_of(plan, form_);
    literals_.values.resize(form_.nodes.size());
    literals_.ranges.resize(form_.nodes.size());
    for (std::size_t n = 0; n < form_.nodes.size(); ++n) {
        const reference::Node& node = form_.nodes[n];
        if (!node.is_atom()) continue;
        literals_.ranges[n] = {ranges.ranges[n].lowest, ranges.ranges[n].highest};
        const auto atom = std::find_if(atoms.begin(), atoms.end(),
                                       [&](const Atom& one) { return is_of(node, one); });
        const auto at = static_cast<std::uint32_t>(atom - atoms.begin());
        for (std::uint32_t step = 0; step < places.steps; ++step) {
            const auto [low, high] =
                etlprove::ends_of(space.diagrams, truths[at], places.atom(step, at));
            const Condition surely(low);
            const Condition possibly(high);
            if (node.negated)
                literals_.values[n].push_back({-possibly, -possibly, -surely, -surely});
            else
                literals_.values[n].push_back({surely, surely, possibly, possibly});
        }
    }
}

Statuses BooleanDefinition::verdict(std::uint32_t monitor, std::uint32_t end,
                                    std::uint32_t position) {
    auto& prefix = prefixes_[end];
    if (!prefix) prefix = std::make_unique<reference::PrefixOf<Condition>>(form_, literals_, end);
    const plan::Monitor& of = plan_.monitors[monitor];
    const reference::ValueOf<Condition> value = prefix->at(form_.roots[of.index], position);
    // "satisfied where rho >= 0, violated where rho_high < 0"; "final where lower >= 0 [...] or
    // upper < 0"
    const Condition final =
        of.sliding ? Condition(etlprove::kAlways) : max(value.lower, -value.upper);
    return {value.rho.diagram(), (-value.rho_high).diagram(), final.diagram()};
}

}  // namespace etlc::prove
