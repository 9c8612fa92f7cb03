#include "plan/automaton.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <unordered_map>

namespace etlc::plan {

namespace {

using ir::Interval;
using ir::Node;
using ir::NodeId;
using ir::Op;
using Set = std::vector<NodeId>;  // sorted, without repeats

/// One way to satisfy a formula at a position: these literals now, these obligations from the next position on.
struct Clause {
    Set literals;
    Set next;
};
using Clauses = std::vector<Clause>;

struct TooLarge {};

Set unite(const Set& a, const Set& b) {
    Set result;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

class Construction {
public:
    Construction(ir::Graph& graph, Literals literals, const AutomatonLimits& limits, AutomatonSize& reached)
        : graph_(graph), literals_(literals), limits_(limits), reached_(reached) {}

    Automaton build(NodeId formula) {
        guard_number({});
        state_number({formula});
        for (std::uint32_t state = 0; state < automaton_.states.size(); ++state) expand_state(state);
        std::sort(automaton_.transitions.begin(), automaton_.transitions.end(), [](const auto& a, const auto& b) {
            return std::tie(a.target, a.guard, a.source) < std::tie(b.target, b.guard, b.source);
        });
        return std::move(automaton_);
    }

private:
    // ---- what implies what

    /// rho of the first is never above rho of the second, at the same position of any prefix.
    bool implies(NodeId stronger, NodeId weaker) const {
        if (stronger == weaker) return true;
        const Node& s = graph_[stronger];
        const Node& w = graph_[weaker];
        if (s.operands.empty() || w.operands.empty() || s.operands.back() != w.operands.back()) return false;
        const bool same_left = s.operands == w.operands;
        switch (s.op) {
            case Op::eventually: return w.op == Op::eventually && w.interval.contains(s.interval);
            case Op::until:
                return ((w.op == Op::until && same_left) || w.op == Op::eventually) && w.interval.contains(s.interval);
            case Op::always: return (w.op == Op::always || w.op == Op::release) && s.interval.contains(w.interval);
            case Op::release: return w.op == Op::release && same_left && s.interval.contains(w.interval);
            default: return false;
        }
    }

    bool all_implied(const Set& weaker, const Set& stronger) const {
        return std::all_of(weaker.begin(), weaker.end(), [&](NodeId w) {
            return std::any_of(stronger.begin(), stronger.end(), [&](NodeId s) { return implies(s, w); });
        });
    }

    /// The first clause makes the second idle: whatever satisfies the second satisfies the first.
    bool absorbs(const Clause& kept, const Clause& dropped) const {
        return std::includes(dropped.literals.begin(), dropped.literals.end(), kept.literals.begin(),
                             kept.literals.end()) &&
               all_implied(kept.next, dropped.next);
    }

    void add(Clauses& clauses, Clause clause) {
        effort_ += kEffortPerClause + clauses.size();
        if (effort_ > kEffortPerTransition * limits_.transitions) throw TooLarge{};
        for (const Clause& other : clauses)
            if (absorbs(other, clause)) return;
        std::erase_if(clauses, [&](const Clause& other) { return absorbs(clause, other); });
        clauses.push_back(std::move(clause));
        if (clauses.size() > limits_.transitions || clauses.size() > kMaxClauses) throw TooLarge{};
    }

    /// G[0,4] f and G[2,9] f are G[0,9] f: windows of one operand that touch become one, so that a requirement which
    /// repeats at every step is one obligation and not a set of them.
    Set merge_always(Set obligations) {
        for (std::size_t i = 0; i < obligations.size(); ++i) {
            for (std::size_t j = i + 1; j < obligations.size(); ++j) {
                const Node a = graph_[obligations[i]];
                const Node& b = graph_[obligations[j]];
                if (a.op != Op::always || b.op != Op::always || a.operands != b.operands) continue;
                const auto touches = [](Interval x, Interval y) { return !x.bounded() || y.low <= x.high + 1; };
                if (!touches(a.interval, b.interval) || !touches(b.interval, a.interval)) continue;
                const Interval whole{std::min(a.interval.low, b.interval.low),
                                     std::max(a.interval.high, b.interval.high)};
                const NodeId merged = graph_.keep(Op::always, whole, a.operands, a.span);
                obligations.erase(obligations.begin() + static_cast<std::ptrdiff_t>(j));
                obligations.erase(obligations.begin() + static_cast<std::ptrdiff_t>(i));
                obligations.insert(std::lower_bound(obligations.begin(), obligations.end(), merged), merged);
                obligations.erase(std::unique(obligations.begin(), obligations.end()), obligations.end());
                return merge_always(std::move(obligations));
            }
        }
        return obligations;
    }

    /// Obligations without those that another of the set implies.
    Set reduce(const Set& unmerged) {
        const Set obligations = merge_always(unmerged);
        Set result;
        for (std::size_t i = 0; i < obligations.size(); ++i) {
            bool idle = false;
            for (std::size_t j = 0; j < obligations.size() && !idle; ++j) {
                if (i == j || !implies(obligations[j], obligations[i])) continue;
                idle = !implies(obligations[i], obligations[j]) || j < i;  // of two equals the first stays
            }
            if (!idle) result.push_back(obligations[i]);
        }
        return result;
    }

    // ---- expansion

    Clauses either(const Clauses& a, const Clauses& b) {
        Clauses result = a;
        for (const Clause& clause : b) add(result, clause);
        return result;
    }

    Clauses both(const Clauses& a, const Clauses& b) {
        Clauses result;
        for (const Clause& x : a)
            for (const Clause& y : b) add(result, {unite(x.literals, y.literals), reduce(unite(x.next, y.next))});
        return result;
    }

    static Clauses always_satisfied() { return {Clause{}}; }
    static Clauses next(NodeId obligation) { return {Clause{{}, {obligation}}}; }

    Clauses literal(NodeId id) const {
        const Node& node = graph_[id];
        if (node.op == Op::constant_true) return always_satisfied();
        if (node.op == Op::constant_false) return {};
        if (node.op == Op::conjunction) return {Clause{node.operands, {}}};  // each for itself: more is absorbed
        return {Clause{{id}, {}}};
    }

    /// The window one step later, as an obligation for the next position. It keeps its operator even where the window
    /// is [0,0], since at the end of the prefix F and U are false there and G and R are true.
    Clauses later(const Node& node) {
        return next(graph_.keep(node.op, node.interval.earlier(), node.operands, node.span));
    }

    const Clauses& expand(NodeId id) {
        if (const auto known = expansions_.find(id); known != expansions_.end()) return known->second;
        Clauses clauses = expand_node(id);
        return expansions_.emplace(id, std::move(clauses)).first->second;
    }

    Clauses expand_node(NodeId id) {
        const Node node = graph_[id];  // a copy: the graph grows meanwhile
        const bool bounded = node.horizon != ir::kUnbounded;
        if (!node.has_future || (literals_ == Literals::with_bounded_future && bounded)) return literal(id);
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
                return last ? expand(node.operands[0]) : either(expand(node.operands[0]), later(node));
            case Op::always:
                if (opens_later) return later(node);
                return last ? expand(node.operands[0]) : both(expand(node.operands[0]), later(node));
            case Op::until: {
                const Clauses wait = last ? Clauses{} : both(expand(node.operands[0]), later(node));
                return opens_later ? wait : either(expand(node.operands[1]), wait);
            }
            case Op::release: {
                const Clauses hold = last ? always_satisfied() : either(expand(node.operands[0]), later(node));
                return opens_later ? hold : both(expand(node.operands[1]), hold);
            }
            default: return literal(id);
        }
    }

    // ---- states and transitions

    std::uint32_t guard_number(const Set& literals) {
        const auto [entry, added] = guards_.emplace(literals, static_cast<std::uint32_t>(automaton_.guards.size()));
        if (added) automaton_.guards.push_back(literals);
        return entry->second;
    }

    std::uint32_t state_number(const Set& obligations) {
        const auto [entry, added] = states_.emplace(obligations, static_cast<std::uint32_t>(automaton_.states.size()));
        if (added) automaton_.states.push_back(obligations);
        reached_.states = automaton_.states.size();
        if (reached_.states > limits_.states) throw TooLarge{};
        return entry->second;
    }

    void expand_state(std::uint32_t state) {
        const Set obligations = automaton_.states[state];
        Clauses clauses = always_satisfied();
        for (NodeId obligation : obligations) clauses = both(clauses, expand(obligation));
        for (const Clause& clause : clauses)
            automaton_.transitions.push_back({state, state_number(clause.next), guard_number(clause.literals)});
        reached_.transitions = automaton_.transitions.size();
        if (reached_.transitions > limits_.transitions) throw TooLarge{};
    }

    static constexpr std::size_t kMaxClauses = 4096;  // absorption compares pairs
    // Where most clauses turn out to be idle, work and not size is what ends a construction.
    static constexpr std::uint64_t kEffortPerClause = 16;
    static constexpr std::uint64_t kEffortPerTransition = 256;

    ir::Graph& graph_;
    Literals literals_;
    const AutomatonLimits& limits_;
    AutomatonSize& reached_;
    Automaton automaton_;
    std::uint64_t effort_ = 0;
    std::unordered_map<NodeId, Clauses> expansions_;
    std::map<Set, std::uint32_t> guards_;
    std::map<Set, std::uint32_t> states_;
};

}  // namespace

bool is_strong(Op op) {
    return op == Op::eventually || op == Op::until;
}

std::optional<Automaton> build_automaton(ir::Graph& graph, NodeId formula, Literals literals,
                                         const AutomatonLimits& limits, AutomatonSize& reached) {
    try {
        return Construction(graph, literals, limits, reached).build(formula);
    } catch (const TooLarge&) {
        return std::nullopt;
    }
}

}  // namespace etlc::plan
