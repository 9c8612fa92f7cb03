#include "prove/symbols/definition.hpp"

#include <algorithm>
#include <optional>
#include <set>
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
    return {is_predicate, index, true, is_truth, missing ? reference::Unseen{said, said} : range,
            range};
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

Definition::Definition(const plan::Plan& plan, const std::vector<Atom>& atoms, std::uint32_t steps,
                       bool missing)
    : plan_(plan), form_(reference::normal_form(*plan.model)), prefixes_(steps) {
    const reference::Literals ranges =
        reference::literals(*plan.model, form_, {}, check::Values::robustness);
    literals_.values.resize(form_.nodes.size());
    literals_.ranges.resize(form_.nodes.size());
    for (std::size_t n = 0; n < form_.nodes.size(); ++n) {
        const reference::Node& node = form_.nodes[n];
        const auto atom = std::find_if(atoms.begin(), atoms.end(), [&](const Atom& one) {
            return node.is_atom() && one.index == node.index &&
                   one.is_predicate == (node.kind == reference::Node::Kind::predicate);
        });
        if (!node.is_atom()) continue;
        literals_.ranges[n] = {ranges.ranges[n].lowest, ranges.ranges[n].highest};
        const auto at = static_cast<std::size_t>(atom - atoms.begin());
        for (std::uint32_t step = 0; step < steps; ++step) {
            const auto end = [&](Place place) {
                return Symbol::variable(etlprove::place_of({step, steps}, at, atoms.size(), place));
            };
            const Place high = missing ? etlprove::kHigh : etlprove::kLow;
            const Place negated_high = missing ? etlprove::kNegatedHigh : etlprove::kNegatedLow;
            const Symbol low = end(node.negated ? negated_high : etlprove::kLow);
            const Symbol up = end(node.negated ? etlprove::kNegatedLow : high);
            literals_.values[n].push_back({low, low, up, up});
        }
    }
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

}  // namespace etlc::prove
