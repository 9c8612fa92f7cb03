#include "plan/decide/schedule.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "plan/decide/automaton.hpp"
#include "plan/decide/straight.hpp"

namespace etlc::plan {

namespace {

template <class Visit>
void for_each_variable(const Term& term, const Visit& visit) {
    if (term.kind == Term::Kind::reg || term.kind == Term::Kind::local) visit(term);
    for (const Term& operand : term.operands) for_each_variable(operand, visit);
}

template <class Times>
std::size_t known(const Times& times, const Term& variable) {
    const auto found = times.find({variable.kind, variable.index});
    return found == times.end() ? 0 : found->second;
}

}  // namespace

Schedule::Schedule(std::vector<Assignment> assignments) : steps_(std::move(assignments)) {
    stores_.resize(steps_.size() + 1);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        for_each_variable(steps_[i].value, [&](const Term& read) { read_by(read, i + 1); });
        assigned_at_[{steps_[i].target, steps_[i].index}] = i + 1;
    }
}

void Schedule::read_by(const Term& variable, std::size_t time) {
    std::size_t& until = read_until_[{variable.kind, variable.index}];
    until = std::max(until, time);
}

void Schedule::add(const Term& to, Term value) {
    Assignment store{.target = to.kind, .index = to.index, .value = std::move(value)};
    std::size_t at = std::max(known(read_until_, to), known(assigned_at_, to));
    for_each_variable(store.value,
                      [&](const Term& read) { at = std::max(at, known(assigned_at_, read)); });
    for_each_variable(store.value, [&](const Term& read) { read_by(read, at); });
    stores_[at].push_back(std::move(store));
}

std::vector<Assignment> Schedule::end() {
    std::vector<Assignment> result = std::move(stores_[0]);
    for (std::size_t i = 0; i < steps_.size(); ++i) {
        result.push_back(std::move(steps_[i]));
        std::move(stores_[i + 1].begin(), stores_[i + 1].end(), std::back_inserter(result));
    }
    return result;
}

// The registers of a small state machine, updated by straight-line code.

namespace {

using LiteralSlots = std::vector<Slot>;  // sorted

/// A register read by an update.
struct Source {
    std::uint32_t state = 0;
    bool updated = false;  ///< this step's value instead of the previous one
};

/// min(max of the sources, literals); the literals alone without sources, because a source that is
/// always true adds nothing.
struct Product {
    std::vector<Source> sources;
    LiteralSlots literals;
};

/// Sets the register of a state to the max of these products; to false without any.
struct Update {
    std::uint32_t state = 0;
    std::vector<Product> products;
};

/// Updates, in order. Those of `first` read old values and each other's results, and are stored
/// last. Those of `in_place` are stored at once, since no later update reads the old value. Where
/// every way into S followed by the guard h is also a way into T, those ways are one: min(S after
/// its update, h). So F (a && F b) is S = max(S, a); T = max(T, min(S, b)): a chain where the
/// transitions alone give a triangle.
struct Updates {
    std::vector<Update> first;
    std::vector<Update> in_place;
};

/// A way into a state: from a register, or from one that is always true, through literals.
struct Way {
    std::uint32_t source = kNone;  ///< kNone: always true
    LiteralSlots literals;

    bool operator==(const Way&) const = default;
};

bool contains(const LiteralSlots& outer, const LiteralSlots& inner) {
    return std::includes(outer.begin(), outer.end(), inner.begin(), inner.end());
}

LiteralSlots unite(const LiteralSlots& a, const LiteralSlots& b) {
    LiteralSlots result;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

/// Returns an order that puts `first` before `second` for each pair, without states on a cycle or
/// after one. Of several that may come next, the last comes first, so a shift runs from its end.
std::vector<std::uint32_t> sorted(std::size_t count,
                                  const std::set<std::pair<std::uint32_t, std::uint32_t>>& before) {
    std::vector<std::size_t> waiting_for(count, 0);
    for (const auto& [first, second] : before) ++waiting_for[second];
    std::set<std::uint32_t> ready;
    for (std::uint32_t i = 0; i < count; ++i)
        if (waiting_for[i] == 0) ready.insert(i);
    std::vector<std::uint32_t> order;
    while (!ready.empty()) {
        order.push_back(*ready.rbegin());
        ready.erase(order.back());
        for (const auto& [first, second] : before)
            if (first == order.back() && --waiting_for[second] == 0) ready.insert(second);
    }
    return order;
}

class Programming {
public:
    explicit Programming(const Machine& machine) : machine_(machine), ways_(machine.states.size()) {
        for (const Transition& t : machine.automaton.transitions) {
            LiteralSlots literals = machine.guards[t.guard];
            std::sort(literals.begin(), literals.end());
            ways_[t.target].push_back(
                {machine.states[t.source].always_true ? kNone : t.source, std::move(literals)});
        }
        original_ = ways_;
        updated_.resize(machine.states.size());
    }

    Updates make() {
        for (std::uint32_t target = 0; target < ways_.size(); ++target)
            for (const Way& way : original_[target])
                if (way.source != kNone && way.source != target) follow(target, way);
        return program();
    }

private:
    using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

    /// Returns whether every way into `from`, continued through `through`, is a way into `target`
    /// too, or a tighter one is.
    bool all_lead_on(std::uint32_t from, const LiteralSlots& through, std::uint32_t target) const {
        return std::all_of(original_[from].begin(), original_[from].end(), [&](const Way& way) {
            const LiteralSlots whole = unite(way.literals, through);
            return std::any_of(original_[target].begin(), original_[target].end(),
                               [&](const Way& other) {
                                   return (other.source == way.source || other.source == kNone) &&
                                          contains(whole, other.literals);
                               });
        });
    }

    /// Reads the updated value of `way.source` if that replaces two ways or more.
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
        if (sorted(ways_.size(), order).size() < ways_.size()) return;
        fresh_ = std::move(order);
        std::erase_if(ways_[target], covered);
        updated_[target].push_back(way);
    }

    /// Returns the updates in order. Moves one state after the other to `first` until no cycle of
    /// updates reads each other's old values.
    Updates program() const {
        std::set<std::uint32_t> first;
        std::vector<std::uint32_t> order = sorted(ways_.size(), order_without(first));
        while (order.size() < ways_.size()) {
            const std::set<std::uint32_t> placed(order.begin(), order.end());
            std::uint32_t state = 0;
            while (first.count(state) != 0 || placed.count(state) != 0) ++state;
            add_with_read(state, first);
            order = sorted(ways_.size(), order_without(first));
        }
        Updates result;
        for (std::uint32_t state : order)
            if (!machine_.states[state].always_true)
                (first.count(state) != 0 ? result.first : result.in_place)
                    .push_back({state, products(state)});
        return result;
    }

    /// Returns pairs of updates, the first before the second: a result before its reader, a reader
    /// of an old value before its writer.
    Pairs order_without(const std::set<std::uint32_t>& first) const {
        Pairs result = fresh_;
        for (std::uint32_t target = 0; target < ways_.size(); ++target)
            for (const Way& way : ways_[target])
                if (way.source != kNone && way.source != target && first.count(target) == 0 &&
                    first.count(way.source) == 0)
                    result.emplace(target, way.source);
        return result;
    }

    /// Adds the state, and the states whose new values its update reads.
    void add_with_read(std::uint32_t state, std::set<std::uint32_t>& first) const {
        first.insert(state);
        for (const auto& [read, reader] : fresh_)
            if (reader == state && first.count(read) == 0) add_with_read(read, first);
    }

    /// Groups the ways into a state by their literals.
    std::vector<Product> products(std::uint32_t state) const {
        std::vector<Product> result;
        const auto product_through = [&](const LiteralSlots& literals) -> Product& {
            const auto found =
                std::find_if(result.begin(), result.end(),
                             [&](const Product& product) { return product.literals == literals; });
            return found != result.end() ? *found : result.emplace_back(Product{{}, literals});
        };
        std::set<LiteralSlots> unconditional;  // true through these literals alone
        for (const Way& way : ways_[state]) {
            if (way.source == kNone)
                unconditional.insert(way.literals);
            else
                product_through(way.literals).sources.push_back({way.source, false});
        }
        for (const Way& way : updated_[state])
            product_through(way.literals).sources.push_back({way.source, true});
        for (const LiteralSlots& literals : unconditional)
            product_through(literals).sources.clear();
        return result;
    }

    const Machine& machine_;
    std::vector<std::vector<Way>> original_;
    std::vector<std::vector<Way>> ways_;     ///< ways that read old values
    std::vector<std::vector<Way>> updated_;  ///< ways that read new values
    Pairs fresh_;  ///< updates that must precede those that read their result
};

/// Writes the code of the updates and of the reading.
class Writing {
public:
    Writing(const Machine& machine, const StreamBuilder& streams)
        : machine_(machine), streams_(streams) {}

    Straight write(const Updates& updates) {
        keep_registers();
        for (const Update& update : updates.first) {
            const std::size_t local = code_.locals.size();
            assign(Term::Kind::local, local, update);
            local_of_.emplace(update.state, local);
            code_.locals.emplace_back("_next");
        }
        for (const Update& update : updates.in_place)
            assign(Term::Kind::reg, register_of(update.state), update);
        for (const Update& update : updates.first)
            code_.assignments.push_back({.index = register_of(update.state),
                                         .value = Term::local(local_of_.at(update.state))});
        read();
        return std::move(code_);
    }

private:
    /// Only the first state can be always true.
    std::uint32_t register_of(std::uint32_t state) const {
        return state - (machine_.states[0].always_true ? 1 : 0);
    }

    /// Adds a register for each state that is not always true.
    void keep_registers() {
        for (std::size_t q = 0; q < machine_.states.size(); ++q) {
            if (machine_.states[q].always_true) continue;
            // In G f the whole formula is pending in every state.
            const std::vector<NodeId>& whole = machine_.automaton.states[0];
            std::vector<NodeId> pending = machine_.automaton.states[q];
            const bool also = q != 0 && contains(pending, whole);
            if (also) std::erase(pending, whole[0]);
            code_.registers.push_back({.first = neutral(q != 0),
                                       .suffix = pending.empty() ? "_met"
                                                 : q == 0        ? "_whole"
                                                                 : "_pending",
                                       .before = pending.empty() ? "nothing is pending"
                                                 : also          ? "also pending: "
                                                                 : "pending: ",
                                       .formulas = pending});
        }
    }

    void assign(Term::Kind target, std::size_t index, const Update& update) {
        std::vector<Term> products;
        for (const Product& product : update.products) products.push_back(value(product));
        code_.assignments.push_back({.target = target,
                                     .index = static_cast<std::uint32_t>(index),
                                     .value = Term::extreme(true, std::move(products))});
    }

    Term value(const Product& product) const {
        std::vector<Term> sources;
        for (const Source& source : product.sources) {
            const auto local = local_of_.find(source.state);
            sources.push_back(source.updated && local != local_of_.end()
                                  ? Term::local(local->second)
                                  : Term::reg(register_of(source.state)));
        }
        std::vector<Term> factors;
        if (!sources.empty()) factors.push_back(Term::extreme(true, std::move(sources)));
        for (Slot slot : product.literals) factors.push_back(streams_.term(slot));
        return Term::extreme(false, std::move(factors));
    }

    /// Computes the bounds: the max over states of min(register, unseen value of its obligations),
    /// of the strong ones for the upper bound, of the weak ones for the lower one, which is false
    /// where a strong one is open.
    void read() {
        std::vector<Term> rho;
        std::vector<Limited> lower;
        std::vector<Limited> upper;
        for (std::uint32_t q = 0; q < machine_.states.size(); ++q) {
            const Machine::State& state = machine_.states[q];
            const Term kept =
                state.always_true ? Term::constant(etlmon::kTrue) : Term::reg(register_of(q));
            upper.push_back({kept, unseen(state.strong_unseen, End::high)});
            if (state.strong) continue;
            rho.push_back(kept);
            lower.push_back({kept, unseen(state.weak_unseen, End::low)});
        }
        code_.rho = Term::extreme(true, std::move(rho));
        code_.lower = best_of(true, lower);
        code_.upper = best_of(true, upper);
    }

    Term unseen(Slot slot, End end) const {
        return slot == kNone ? Term::constant(etlmon::kTrue) : streams_.term(slot, end);
    }

    const Machine& machine_;
    const StreamBuilder& streams_;
    std::map<std::uint32_t, std::size_t> local_of_;  ///< per state that is updated first
    Straight code_;
};

}  // namespace

Straight straight_line(const Machine& machine, const StreamBuilder& streams) {
    return Writing(machine, streams).write(Programming(machine).make());
}

}  // namespace etlc::plan
