#include "plan/decide/automaton.hpp"

#include <algorithm>
#include <tuple>
#include <unordered_map>

namespace etlc::plan {

namespace {

using ir::Interval;
using ir::Node;
using ir::NodeId;
using ir::Op;
using Set = std::vector<NodeId>;  // sorted, without repeats

/// One way to satisfy a formula at a position: these literals now, these obligations from the next
/// position on.
struct Clause {
    Set literals;
    Set next;
};
using Clauses = std::vector<Clause>;

struct TooLarge {};

struct HashOfSet {
    std::size_t operator()(const Set& set) const {
        std::size_t hash = set.size();
        for (NodeId id : set) hash = (hash ^ id) * 0x9e3779b97f4a7c15ULL + (hash >> 29U);
        return hash;
    }
};

void unite(const Set& a, const Set& b, Set& result) {
    result.clear();
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
}

class Construction {
public:
    Construction(ir::Graph& graph, Literals literals, const AutomatonLimits& limits,
                 AutomatonSize& reached)
        : graph_(graph), literals_(literals), limits_(limits), reached_(reached) {}

    Automaton build(NodeId formula) {
        guard_number({});
        state_number({formula});
        for (std::uint32_t state = 0; state < automaton_.states.size(); ++state)
            expand_state(state);
        std::sort(automaton_.transitions.begin(), automaton_.transitions.end(),
                  [](const auto& a, const auto& b) {
                      return std::tie(a.target, a.guard, a.source) <
                             std::tie(b.target, b.guard, b.source);
                  });
        return std::move(automaton_);
    }

    std::uint64_t work() const { return work_; }

private:
    void spend(std::uint64_t steps) {
        work_ += steps;
        if (work_ <= limits_.work) return;
        reached_.out_of_work = true;
        throw TooLarge{};
    }

    // ---- what implies what

    /// Returns whether rho of the first never exceeds rho of the second, at the same position of
    /// any prefix.
    bool implies(NodeId stronger, NodeId weaker) const {
        if (stronger == weaker) return true;
        const Node& s = graph_[stronger];
        const Node& w = graph_[weaker];
        if (s.operands.empty() || w.operands.empty() || s.operands.back() != w.operands.back())
            return false;
        const bool same_left = s.operands == w.operands;
        switch (s.op) {
            case Op::eventually: return w.op == Op::eventually && w.interval.contains(s.interval);
            case Op::until:
                return ((w.op == Op::until && same_left) || w.op == Op::eventually) &&
                       w.interval.contains(s.interval);
            case Op::always:
                return (w.op == Op::always || w.op == Op::release) &&
                       s.interval.contains(w.interval);
            case Op::release:
                return w.op == Op::release && same_left && s.interval.contains(w.interval);
            default: return false;
        }
    }

    bool implied(NodeId weaker, const Set& stronger) {
        spend(1);
        if (std::binary_search(stronger.begin(), stronger.end(), weaker)) return true;
        spend(stronger.size());
        return std::any_of(stronger.begin(), stronger.end(),
                           [&](NodeId s) { return implies(s, weaker); });
    }

    /// Returns whether the first clause makes the second redundant: whatever satisfies the second
    /// satisfies the first.
    bool absorbs(const Clause& kept, const Clause& dropped) {
        spend(1);
        if (kept.literals.size() > dropped.literals.size()) return false;
        spend(dropped.literals.size());
        return std::includes(dropped.literals.begin(), dropped.literals.end(),
                             kept.literals.begin(), kept.literals.end()) &&
               std::all_of(kept.next.begin(), kept.next.end(),
                           [&](NodeId w) { return implied(w, dropped.next); });
    }

    void add(Clauses& clauses, const Clause& clause) {
        effort_ += kEffortPerClause + clauses.size();
        if (effort_ > kEffortPerTransition * limits_.transitions) throw TooLarge{};
        for (const Clause& other : clauses)
            if (absorbs(other, clause)) return;
        std::erase_if(clauses, [&](const Clause& other) { return absorbs(clause, other); });
        spend(kWorkPerClause + clause.literals.size() + clause.next.size());
        clauses.push_back(clause);
        if (clauses.size() > limits_.transitions || clauses.size() > kMaxClauses) throw TooLarge{};
    }

    /// Returns whether the windows touch and have the same operand.
    bool merge(NodeId first, NodeId second) const {
        const Node& a = graph_[first];
        const Node& b = graph_[second];
        if (a.op != Op::always || b.op != Op::always || a.operands != b.operands) return false;
        const auto touches = [](Interval x, Interval y) {
            return !x.bounded() || y.low <= x.high + 1;
        };
        return touches(a.interval, b.interval) && touches(b.interval, a.interval);
    }

    /// Merges G[0,4] f and G[2,9] f into G[0,9] f, so that a requirement that repeats at every step
    /// is one obligation instead of a set.
    void merge_always(Set& obligations) {
        for (std::size_t i = 0; i < obligations.size(); ++i) {
            if (graph_[obligations[i]].op != Op::always) continue;
            spend(obligations.size() - i);
            for (std::size_t j = i + 1; j < obligations.size(); ++j) {
                if (!merge(obligations[i], obligations[j])) continue;
                const Node a = graph_[obligations[i]];  // a copy: the graph grows meanwhile
                const Interval b = graph_[obligations[j]].interval;
                const Interval whole{std::min(a.interval.low, b.low),
                                     std::max(a.interval.high, b.high)};
                const NodeId merged = keep(a, whole);
                obligations.erase(obligations.begin() + static_cast<std::ptrdiff_t>(j));
                obligations.erase(obligations.begin() + static_cast<std::ptrdiff_t>(i));
                obligations.insert(std::lower_bound(obligations.begin(), obligations.end(), merged),
                                   merged);
                obligations.erase(std::unique(obligations.begin(), obligations.end()),
                                  obligations.end());
                return merge_always(obligations);
            }
        }
    }

    /// Removes obligations that another one implies. (Only equal ones imply each other mutually.)
    void reduce(Set& obligations) {
        merge_always(obligations);
        const Set all = obligations;
        std::erase_if(obligations, [&](NodeId weaker) {
            spend(all.size());
            return std::any_of(all.begin(), all.end(), [&](NodeId stronger) {
                return stronger != weaker && implies(stronger, weaker);
            });
        });
    }

    /// Computes the union of two reduced sets.
    void owe_both(const Set& a, const Set& b, Set& result) {
        spend(a.size() + b.size() + 2 * a.size() * b.size());
        bool related = false;
        for (NodeId x : a)
            for (NodeId y : b)
                related = related || (x != y && (implies(x, y) || implies(y, x) || merge(x, y)));
        unite(a, b, result);
        if (related) reduce(result);
    }

    // ---- expansion

    void spend_on(const Clauses& clauses) {
        for (const Clause& clause : clauses)
            spend(kWorkPerClause + clause.literals.size() + clause.next.size());
    }

    Clauses either(const Clauses& a, const Clauses& b) {
        spend_on(a);
        Clauses result = a;
        for (const Clause& clause : b) add(result, clause);
        return result;
    }

    Clauses both(const Clauses& a, const Clauses& b) {
        Clauses result;
        Clause made;
        for (const Clause& x : a)
            for (const Clause& y : b) {
                spend(x.literals.size() + y.literals.size());
                unite(x.literals, y.literals, made.literals);
                owe_both(x.next, y.next, made.next);
                add(result, made);
            }
        return result;
    }

    static Clauses always_satisfied() { return {Clause{}}; }
    static Clauses next(NodeId obligation) { return {Clause{{}, {obligation}}}; }

    Clauses literal(NodeId id) const {
        const Node& node = graph_[id];
        if (node.op == Op::constant_true) return always_satisfied();
        if (node.op == Op::constant_false) return {};
        if (node.op == Op::conjunction)
            return {Clause{node.operands, {}}};  // separately, so that more is absorbed
        return {Clause{{id}, {}}};
    }

    /// Returns the window one step later, as an obligation for the next position. It stays an
    /// operator even for [0,0], since at the end of the prefix F and U are false there, and G and R
    /// are true.
    Clauses later(const Node& node) { return next(keep(node, node.interval.earlier())); }

    NodeId keep(const Node& node, Interval interval) {
        spend(kWorkPerNode);
        return graph_.keep(node.op, interval, node.operands, node.span);
    }

    const Clauses& expand(NodeId id) {
        if (const auto known = expansions_.find(id); known != expansions_.end())
            return known->second;
        Clauses clauses = expand_node(id);
        return expansions_.emplace(id, std::move(clauses)).first->second;
    }

    Clauses expand_node(NodeId id) {
        const Node node = graph_[id];  // a copy: the graph grows meanwhile
        const bool bounded = node.horizon != ir::kUnbounded;
        if (!node.has_future || (literals_ == Literals::with_bounded_future && bounded))
            return literal(id);
        const bool opens_later = node.interval.low > 0;
        const bool last = node.interval.high == 0;
        switch (node.op) {
            case Op::conjunction: {
                Clauses result = always_satisfied();
                for (NodeId operand : node.operands) result = both(result, expand(operand));
                return result;
            }
            case Op::disjunction: {
                Clauses result;
                for (NodeId operand : node.operands) result = either(result, expand(operand));
                return result;
            }
            case Op::eventually:
                if (opens_later) return later(node);
                return last ? expand(node.operands[0])
                            : either(expand(node.operands[0]), later(node));
            case Op::always:
                if (opens_later) return later(node);
                return last ? expand(node.operands[0])
                            : both(expand(node.operands[0]), later(node));
            case Op::until: {
                const Clauses wait = last ? Clauses{} : both(expand(node.operands[0]), later(node));
                return opens_later ? wait : either(expand(node.operands[1]), wait);
            }
            case Op::release: {
                const Clauses hold =
                    last ? always_satisfied() : either(expand(node.operands[0]), later(node));
                return opens_later ? hold : both(expand(node.operands[1]), hold);
            }
            default: return literal(id);
        }
    }

    // ---- states and transitions

    std::uint32_t guard_number(const Set& literals) {
        spend(kWorkPerClause + literals.size());
        const auto [entry, added] =
            guards_.emplace(literals, static_cast<std::uint32_t>(automaton_.guards.size()));
        if (added) automaton_.guards.push_back(literals);
        return entry->second;
    }

    std::uint32_t state_number(const Set& obligations) {
        spend(obligations.size());
        const auto [entry, added] =
            states_.emplace(obligations, static_cast<std::uint32_t>(automaton_.states.size()));
        if (added) {
            spend(kWorkPerState + kWorkPerObligation * obligations.size());
            automaton_.states.push_back(obligations);
        }
        reached_.states = automaton_.states.size();
        if (reached_.states > limits_.states) throw TooLarge{};
        return entry->second;
    }

    void expand_state(std::uint32_t state) {
        const Set obligations = automaton_.states[state];
        Clauses clauses = always_satisfied();
        for (NodeId obligation : obligations) clauses = both(clauses, expand(obligation));
        for (const Clause& clause : clauses)
            automaton_.transitions.push_back(
                {state, state_number(clause.next), guard_number(clause.literals)});
        reached_.transitions = automaton_.transitions.size();
        if (reached_.transitions > limits_.transitions) throw TooLarge{};
    }

    static constexpr std::size_t kMaxClauses = 4096;  // absorption compares pairs
    // Where most clauses turn out to be idle, work and not size is what ends a construction.
    static constexpr std::uint64_t kEffortPerClause = 16;
    static constexpr std::uint64_t kEffortPerTransition = 256;
    // Work per clause and per transition, in loop steps over a set, including the work of the users
    // of the automaton.
    static constexpr std::uint64_t kWorkPerClause = 32;
    static constexpr std::uint64_t kWorkPerNode = 256;
    static constexpr std::uint64_t kWorkPerState = 256;
    static constexpr std::uint64_t kWorkPerObligation = 32;

    ir::Graph& graph_;
    Literals literals_;
    const AutomatonLimits& limits_;
    AutomatonSize& reached_;
    Automaton automaton_;
    std::uint64_t effort_ = 0;
    std::uint64_t work_ = 0;
    std::unordered_map<NodeId, Clauses> expansions_;
    std::unordered_map<Set, std::uint32_t, HashOfSet> guards_;
    std::unordered_map<Set, std::uint32_t, HashOfSet> states_;
};

}  // namespace

bool is_strong(Op op) {
    return op == Op::eventually || op == Op::until;
}

std::optional<Automaton> build_automaton(ir::Graph& graph, NodeId formula, Literals literals,
                                         const AutomatonLimits& limits, AutomatonSize& reached) {
    Construction construction(graph, literals, limits, reached);
    std::optional<Automaton> automaton;
    try {
        automaton = construction.build(formula);
    } catch (const TooLarge&) {
    }
    reached.work = construction.work();
    return automaton;
}

namespace {

/// Returns the index of a stream's key in its list; 0, the neutral key, for no stream.
std::uint16_t index_of(std::vector<Slot>& list, Slot slot) {
    if (slot == kNone) return 0;
    const auto found = std::find(list.begin(), list.end(), slot);
    const auto index = static_cast<std::uint16_t>(found - list.begin() + 1);
    if (found == list.end()) list.push_back(slot);
    return index;
}

}  // namespace

Table make_table(const Machine& machine) {
    Table table;
    table.ends.assign(machine.states.size(), 0);
    for (const Transition& t : machine.automaton.transitions) {  // sorted by target
        table.transitions.push_back(
            {static_cast<std::uint16_t>(t.source), static_cast<std::uint16_t>(t.guard)});
        table.ends[t.target] = static_cast<std::uint32_t>(table.transitions.size());
    }
    for (std::size_t q = 1; q < table.ends.size(); ++q)
        table.ends[q] = std::max(table.ends[q], table.ends[q - 1]);
    for (const Machine::State& state : machine.states) {
        const std::uint16_t weak =
            state.strong ? etlmon::kStrongly : index_of(table.weak, state.weak_unseen);
        table.owed.push_back({weak, index_of(table.strong, state.strong_unseen)});
    }
    table.guards = machine.guards;
    table.obligations = machine.automaton.states;
    return table;
}

bool is_small(const Machine& machine) {
    return machine.states.size() <= kMaxUnrolledStates &&
           machine.automaton.transitions.size() <= kMaxUnrolledTransitions;
}

}  // namespace etlc::plan
