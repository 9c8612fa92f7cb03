// The registers of a small state machine, updated by straight-line code.
#include <algorithm>
#include <set>

#include "plan/program/machine.hpp"

namespace etlc::plan {

namespace {

using Literals = std::vector<Slot>;  // sorted

/// One way into a state: from a register (or from what is always true) through literals.
struct Way {
    std::uint32_t source = kNone;  ///< kNone: always true
    Literals literals;

    bool operator==(const Way&) const = default;
};

bool contains(const Literals& outer, const Literals& inner) {
    return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
}

Literals unite(const Literals& a, const Literals& b) {
    Literals result;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

/// An order of count > 0 states that puts `first` before `second` for each pair; empty where there
/// is none.
std::vector<std::uint32_t> sorted(std::size_t count,
                                  const std::set<std::pair<std::uint32_t, std::uint32_t>>& before) {
    std::vector<std::size_t> waiting_for(count, 0);
    for (const auto& [first, second] : before) ++waiting_for[second];
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < count; ++i)
        if (waiting_for[i] == 0) order.push_back(i);
    for (std::size_t i = 0; i < order.size(); ++i)
        for (const auto& [first, second] : before)
            if (first == order[i] && --waiting_for[second] == 0) order.push_back(second);
    if (order.size() != count) order.clear();
    return order;
}

class Programming {
public:
    explicit Programming(const Machine& machine) : machine_(machine), ways_(machine.states.size()) {
        for (const Transition& t : machine.automaton.transitions) {
            Literals literals = machine.guards[t.guard];
            std::sort(literals.begin(), literals.end());
            ways_[t.target].push_back(
                {machine.states[t.source].always_true ? kNone : t.source, std::move(literals)});
        }
        original_ = ways_;
        updated_.resize(machine.states.size());
    }

    RegisterProgram make() {
        for (std::uint32_t target = 0; target < ways_.size(); ++target)
            for (const Way& way : original_[target])
                if (way.source != kNone && way.source != target) follow(target, way);
        return program();
    }

private:
    using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

    /// Every way into `from`, then `through`, is a way into `target` too, or a tighter one is.
    bool all_lead_on(std::uint32_t from, const Literals& through, std::uint32_t target) const {
        return std::all_of(original_[from].begin(), original_[from].end(), [&](const Way& way) {
            const Literals whole = unite(way.literals, through);
            return std::any_of(original_[target].begin(), original_[target].end(),
                               [&](const Way& other) {
                                   return (other.source == way.source || other.source == kNone) &&
                                          contains(whole, other.literals);
                               });
        });
    }

    /// Reads the updated value of `way.source` where that replaces two ways or more.
    void follow(std::uint32_t target, const Way& way) {
        if (!all_lead_on(way.source, way.literals, target)) return;
        const auto covered = [&](const Way& other) {
            return std::any_of(
                original_[way.source].begin(), original_[way.source].end(), [&](const Way& into) {
                    return into.source == other.source &&
                           contains(other.literals, unite(into.literals, way.literals));
                });
        };
        if (std::count_if(ways_[target].begin(), ways_[target].end(), covered) < 2) return;
        Pairs order = fresh_;
        order.emplace(way.source, target);
        if (sorted(ways_.size(), order).empty()) return;
        fresh_ = std::move(order);
        std::erase_if(ways_[target], covered);
        updated_[target].push_back(way);
    }

    RegisterProgram program() const {
        Pairs in_place = fresh_;
        for (std::uint32_t target = 0; target < ways_.size(); ++target)
            for (const Way& way : ways_[target])
                if (way.source != kNone && way.source != target)
                    in_place.emplace(target, way.source);
        std::vector<std::uint32_t> order = sorted(ways_.size(), in_place);
        RegisterProgram result{{}, !order.empty()};
        if (order.empty()) order = sorted(ways_.size(), fresh_);
        for (std::uint32_t state : order)
            if (!machine_.states[state].always_true)
                result.updates.push_back({state, terms(state)});
        return result;
    }

    /// The ways into a state, those through the same literals together.
    std::vector<Term> terms(std::uint32_t state) const {
        std::vector<Term> result;
        const auto term_through = [&](const Literals& literals) -> Term& {
            const auto found = std::find_if(result.begin(), result.end(), [&](const Term& term) {
                return term.literals == literals;
            });
            return found != result.end() ? *found : result.emplace_back(Term{{}, literals});
        };
        std::set<Literals> unconditional;  // through these alone, whatever the registers
        for (const Way& way : ways_[state]) {
            if (way.source == kNone)
                unconditional.insert(way.literals);
            else
                term_through(way.literals).sources.push_back({way.source, false});
        }
        for (const Way& way : updated_[state])
            term_through(way.literals).sources.push_back({way.source, true});
        for (const Literals& literals : unconditional) term_through(literals).sources.clear();
        return result;
    }

    const Machine& machine_;
    std::vector<std::vector<Way>> original_;
    std::vector<std::vector<Way>> ways_;     ///< that still read old values
    std::vector<std::vector<Way>> updated_;  ///< that read new ones
    Pairs fresh_;  ///< updates that must come before others that read their result
};

}  // namespace

RegisterProgram make_register_program(const Machine& machine) {
    return Programming(machine).make();
}

std::size_t operations(const RegisterProgram& program) {
    std::size_t count = 0;
    for (const Update& update : program.updates) {
        count += update.terms.empty() ? 0 : update.terms.size() - 1;
        for (const Term& term : update.terms) {
            const std::size_t factors =
                term.literals.size() + (term.sources.empty() ? 0 : term.sources.size());
            count += factors == 0 ? 0 : factors - 1;
        }
    }
    return count;
}

}  // namespace etlc::plan
