#include "plan/decide/chain.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <unordered_map>
#include <utility>

#include "plan/decide/schedule.hpp"
#include "plan/decide/straight.hpp"

namespace etlc::plan {

namespace {

using ir::Interval;
using ir::Node;
using ir::Op;

/// A place that ways pass through: a formula that begins at this step or, as an obligation, is open
/// from the next step on. An unbounded operator from now on is both.
struct Place {
    NodeId formula = 0;
    bool owed = false;

    auto operator<=>(const Place&) const = default;
};

class ChainWriting {
public:
    ChainWriting(StreamBuilder& streams, ir::Graph& graph, bool max)
        : streams_(streams), graph_(graph), is_{max} {}

    Straight write(NodeId root) {
        const Place start = owe(root);
        order(start);
        std::reverse(order_.begin(), order_.end());
        begin(start);
        for (const Place& place : order_) pass(place);
        settle();
        Schedule schedule(std::move(code_.assignments));
        for (auto place = order_.rbegin(); place != order_.rend(); ++place) keep(*place, schedule);
        code_.assignments = schedule.end();
        read();
        return std::move(code_);
    }

private:
    /// The state of a place during one step.
    struct Visit {
        std::vector<Term> now;      ///< ways that arrive at this step
        std::vector<Term> next;     ///< ways that arrive at the next one
        std::optional<Term> kept;   ///< its register, if it has one, or a constant
        std::optional<Term> stays;  ///< the ways that stay for the next step
    };

    // ---- terms of a chain of either kind

    Term best(std::vector<Term> terms) const { return Term::extreme(is_.max, std::move(terms)); }
    Term through(Term way, const std::vector<NodeId>& literals) {
        std::vector<Term> terms{std::move(way)};
        for (NodeId literal : literals) terms.push_back(streams_.term(streams_.of(literal)));
        return Term::extreme(!is_.max, std::move(terms));
    }
    std::vector<NodeId> parts(NodeId id, Op op) const {
        return graph_[id].op == op ? graph_[id].operands : std::vector<NodeId>{id};
    }

    // ---- places

    bool is_open_ended(const Node& node) const {
        return ir::info(node.op).tense == ir::Tense::future && node.interval == Interval{};
    }

    /// Returns the place of a formula that must hold from the next step on. X F f and F f are one
    /// where both are false at the end of the prefix, and likewise for their duals.
    Place owe(NodeId id) const {
        const Node& node = graph_[id];
        if (is_open_ended(node)) return {id, false};
        if (node.interval == Interval{0, 0} && ir::info(node.op).tense == ir::Tense::future) {
            const Node& inner = graph_[node.operands[0]];
            if (is_open_ended(inner) && ir::takes_max(inner.op) == ir::takes_max(node.op))
                return {node.operands[0], false};
        }
        return {id, true};
    }

    Place later(const Node& node) {
        return owe(graph_.keep(node.op, node.interval.earlier(), node.operands, node.span));
    }

    /// Calls to(place) for each place that ways reach from this one.
    template <class To>
    void for_each_beyond(const Place& place, const To& to) {
        const Node node = graph_[place.formula];  // a copy: the graph grows meanwhile
        const auto now = [&](NodeId id) { to(Place{id, false}); };
        if (place.owed) return now(place.formula);
        if (!node.has_future) return;
        if (node.op == is_.either() || node.op == is_.both()) {
            for (NodeId operand : node.operands)
                if (graph_[operand].has_future) now(operand);
            return;
        }
        const bool opens_later = node.interval.low > 0;
        if (opens_later) to(later(node));
        if (node.op == is_.guard()) now(node.operands[0]);
        if (is_chosen(node)) {
            const Choice choice = *choice_of(graph_, is_, node);
            std::for_each(choice.beyond.begin(), choice.beyond.end(), now);
        } else if (node.op != is_.guard() && !opens_later) {
            now(node.operands.back());
        }
    }

    /// Returns whether the operator is open-ended, of the other kind, and waits for what looks
    /// ahead.
    bool is_chosen(const Node& node) const {
        if (!is_open_ended(node) || is_.is_owed(node.op)) return false;
        return graph_[node.operands.back()].has_future &&
               (node.op == is_.hold() || !beside(graph_, node, is_.either()));
    }

    /// Adds the places that ways reach, those beyond a place before it.
    void order(const Place& place) {
        if (!graph_[place.formula].has_future) return;
        if (!visits_.emplace(place, Visit{}).second) return;
        for_each_beyond(place, [&](const Place& beyond) { order(beyond); });
        order_.push_back(place);
    }

    // ---- the step, forwards

    /// Adds the registers. The first one begins true (in the dual: false).
    void begin(const Place& start) {
        for (const Place& place : order_) {
            const Node& node = graph_[place.formula];
            if (!place.owed && !is_open_ended(node)) continue;
            Visit& visit = visits_.at(place);
            const bool first = place == start;
            if (first && node.op == is_.seek() && is_open_ended(node)) {
                visit.kept = Term::constant(neutral(!is_.max));
                continue;
            }
            visit.kept = Term::reg(code_.registers.size());
            code_.registers.push_back({.first = neutral(first ? !is_.max : is_.max),
                                       .suffix = first ? "_whole" : "_pending",
                                       .before = "pending: ",
                                       .formulas = {place.formula}});
        }
    }

    void assign(const Term& to, Term value) {
        code_.assignments.push_back(
            {.target = to.kind, .index = to.index, .value = std::move(value)});
    }

    /// Returns the term, by a name if it is not one operand.
    Term named(Term term) {
        if (term.operands.empty()) return term;
        const Term local = Term::local(code_.locals.size());
        code_.locals.emplace_back("_open");
        assign(local, std::move(term));
        return local;
    }

    void arrive(NodeId id, const Term& way) {
        if (!graph_[id].has_future)
            done_.push_back(through(way, parts(id, is_.both())));
        else
            visits_.at({id, false}).now.push_back(way);
    }

    void arrive_later(const Node& node, const Term& way) {
        visits_.at(later(node)).next.push_back(way);
    }

    void pass(const Place& place) {
        const Node node = graph_[place.formula];  // a copy: the graph grows meanwhile
        Visit& visit = visits_.at(place);
        if (place.owed) return arrive(place.formula, *visit.kept);
        if (!visit.kept) return begin_now(node, best(visit.now));
        std::vector<Term> ways{*visit.kept};
        ways.insert(ways.end(), visit.now.begin(), visit.now.end());
        pass_open_ended(node, visit, best(std::move(ways)));
    }

    /// Passes a way to what a formula without a register asks for.
    void begin_now(const Node& node, Term way) {
        if (node.op == is_.either()) {
            std::vector<NodeId> present;
            way = named(std::move(way));
            for (NodeId operand : node.operands)
                graph_[operand].has_future ? arrive(operand, way) : present.push_back(operand);
            if (!present.empty()) arrive(graph_.combine(node.op, present, node.span), way);
            return;
        }
        if (node.op == is_.both()) {
            std::vector<NodeId> present;
            NodeId ahead = 0;
            for (NodeId operand : node.operands)
                graph_[operand].has_future ? void(ahead = operand) : present.push_back(operand);
            return arrive(ahead, through(std::move(way), present));
        }
        if (node.interval.low == 0) return arrive(node.operands[0], way);  // over [0,0]
        if (node.op == is_.guard()) {
            way = named(std::move(way));
            arrive(node.operands[0], way);
        }
        if (node.op == is_.wait())
            way = through(std::move(way), parts(node.operands[0], is_.both()));
        arrive_later(node, way);
    }

    /// Passes the open ways of an unbounded operator on, and computes which of them stay.
    void pass_open_ended(const Node& node, Visit& visit, Term open) {
        const NodeId last = node.operands.back();
        if (node.op == is_.seek()) {
            open = stored(visit, std::move(open));
            arrive(last, open);
            visit.stays = *visit.kept;
        } else if (is_chosen(node)) {
            pass_choice(node, visit, named(std::move(open)));
        } else if (node.op == is_.hold()) {
            visit.stays = through(std::move(open), parts(last, is_.both()));
        } else if (node.op == is_.wait()) {
            open = named(std::move(open));
            arrive(last, open);
            visit.stays = through(open, parts(node.operands[0], is_.both()));
        } else if (!graph_[last].has_future) {
            arrive(node.operands[0],
                   stored(visit, through(std::move(open), parts(last, is_.both()))));
            visit.stays = *visit.kept;
        } else {
            open = named(std::move(open));
            arrive(node.operands[0], open);
            const NodeId other =
                graph_.combine(is_.either(), *beside(graph_, node, is_.either()), node.span);
            visit.stays = through(open, {other});
        }
    }

    /// Passes the open ways of a choice on (chain.hpp).
    void pass_choice(const Node& node, Visit& visit, const Term& open) {
        const Choice choice = *choice_of(graph_, is_, node);
        if (choice.is_late) {
            visit.stays = through(open, parts(choice.present[0], is_.both()));
            for (NodeId beyond : choice.beyond)
                arrive(beyond, through(open, parts(node.operands[0], is_.both())));
            return;
        }
        const NodeId begins = graph_.combine(is_.either(), choice.present, node.span);
        visit.stays = through(open, parts(begins, is_.both()));
        for (NodeId beyond : choice.beyond) arrive(beyond, open);
        if (node.op == is_.guard()) arrive(node.operands[0], *visit.stays);
    }

    /// Stores a value at once: what follows in this step reads the new one.
    Term stored(const Visit& visit, Term value) {
        if (visit.kept->kind == Term::Kind::reg && value != *visit.kept)
            assign(*visit.kept, std::move(value));
        return *visit.kept;
    }

    /// Stores the ways with nothing pending.
    void settle() {
        if (best(done_) == Term::constant(neutral(is_.max))) return;  // what is done adds nothing
        settled_ = Term::reg(code_.registers.size());
        code_.registers.push_back(
            {.first = neutral(is_.max),
             .suffix = is_.max ? "_met" : "_settled",
             .before = is_.max ? "nothing is pending" : "where nothing is pending"});
        done_.insert(done_.begin(), *settled_);
        assign(*settled_, best(done_));
    }

    // ---- the step, backwards

    /// Joins ways through the same literals: max(min(a, p), min(b, p)) to min(max(a, b), p).
    std::vector<Term> joined(std::vector<Term> ways) const {
        const auto is_through = [&](const Term& way) {
            return way.kind == Term::Kind::extreme && way.max != is_.max;
        };
        std::vector<Term> result;
        for (Term& way : ways) {
            const auto same = std::find_if(result.begin(), result.end(), [&](const Term& other) {
                return is_through(way) && is_through(other) &&
                       std::equal(way.operands.begin() + 1, way.operands.end(),
                                  other.operands.begin() + 1, other.operands.end());
            });
            if (same == result.end()) {
                result.push_back(std::move(way));
                continue;
            }
            std::vector<Term> operands = std::move(same->operands);
            operands[0] = best({std::move(operands[0]), std::move(way.operands[0])});
            *same = Term::extreme(!is_.max, std::move(operands));
        }
        return result;
    }

    /// Stores what the next step needs.
    void keep(const Place& place, Schedule& schedule) {
        Visit& visit = visits_.at(place);
        if (!visit.kept || visit.kept->kind != Term::Kind::reg) return;
        std::vector<Term> ways = visit.next;
        if (visit.stays) ways.insert(ways.begin(), *visit.stays);
        Term value = best(joined(std::move(ways)));
        if (value != *visit.kept) schedule.add(*visit.kept, std::move(value));
    }

    // ---- the reading

    /// Computes the bounds as for a state machine: of two unseen values of each obligation, one
    /// counts towards what may still come, the other where the obligation may stay open forever.
    void read() {
        std::vector<Term> rho;
        std::vector<Limited> hope;
        std::vector<Limited> sure;
        const Term anything = Term::constant(neutral(!is_.max));
        if (settled_) {
            rho.push_back(*settled_);
            hope.push_back({*settled_, anything});
            sure.push_back({*settled_, anything});
        }
        const End far = is_.max ? End::high : End::low;
        const End near = is_.max ? End::low : End::high;
        for (const Place& place : order_) {
            const Visit& visit = visits_.at(place);
            if (!visit.kept) continue;
            const Slot unseen = streams_.unseen(place.formula);
            if (is_.is_owed(graph_[place.formula].op)) {
                hope.push_back({*visit.kept, streams_.term(unseen, far)});
                continue;
            }
            rho.push_back(*visit.kept);
            hope.push_back({*visit.kept, anything});
            sure.push_back({*visit.kept, streams_.term(unseen, near)});
        }
        code_.rho = best(std::move(rho));
        (is_.max ? code_.lower : code_.upper) = best_of(is_.max, sure);
        (is_.max ? code_.upper : code_.lower) = best_of(is_.max, hope);
    }

    StreamBuilder& streams_;
    ir::Graph& graph_;
    ChainOperators is_;
    std::vector<Place> order_;  ///< those beyond a place after it
    std::map<Place, Visit> visits_;
    std::vector<Term> done_;
    std::optional<Term> settled_;
    Straight code_;
};

std::size_t operations(const Straight& code) {
    std::size_t sum =
        2 * combinations(code.rho) + combinations(code.lower) + combinations(code.upper);
    for (const Assignment& assignment : code.assignments) sum += 2 * combinations(assignment.value);
    return sum;
}

}  // namespace

std::optional<Straight> chain(StreamBuilder& streams, ir::Graph& graph, NodeId id) {
    std::optional<Straight> found;
    for (const bool max : {true, false}) {
        if (!is_chain(graph, {max}, id)) continue;
        Straight code = ChainWriting(streams, graph, max).write(id);
        if (!found || operations(code) < operations(*found)) found = std::move(code);
    }
    return found;
}

using ir::NodeId;

namespace {

/// Formulas with longer delays are left to the other readings: a chain has a register for each
/// step.
constexpr std::uint32_t kLongestDelay = 8;

/// Finds out whether a formula is a chain.
class ChainRecognition {
public:
    ChainRecognition(const ir::Graph& graph, ChainOperators operators)
        : graph_(graph), is_(operators) {}

    bool is_chain(NodeId id) {
        if (!looks_ahead(id)) return true;
        if (const auto known = known_.find(id); known != known_.end()) return known->second;
        const bool result = is_chain(graph_[id]);
        known_.emplace(id, result);
        return result;
    }

private:
    bool looks_ahead(NodeId id) const { return graph_[id].has_future; }

    bool is_chain(const Node& node) {
        if (node.op == is_.either() || node.op == is_.both())
            return (node.op == is_.either() || one_looks_ahead(node)) &&
                   std::all_of(node.operands.begin(), node.operands.end(),
                               [&](NodeId operand) { return is_chain(operand); });
        if (ir::info(node.op).tense != ir::Tense::future) return false;
        const NodeId last = node.operands.back();
        const Interval interval = node.interval;
        const bool is_delay = interval.low == interval.high;
        if (interval.low > kLongestDelay || (interval.bounded() && !is_delay)) return false;
        if (node.op == is_.seek() || (node.op == is_.hold() && is_delay)) return is_chain(last);
        if (node.op == is_.hold()) return !looks_ahead(last) || is_choice(node);
        if (is_delay) return false;
        if (node.op == is_.wait()) return !looks_ahead(node.operands[0]) && is_chain(last);
        if (looks_ahead(last) && !beside(graph_, node, is_.either())) return is_choice(node);
        return is_chain(node.operands[0]);
    }

    bool is_choice(const Node& node) {
        const auto choice = choice_of(graph_, is_, node);
        return choice && is_chain(node.operands[0]) &&
               std::all_of(choice->beyond.begin(), choice->beyond.end(),
                           [&](NodeId beyond) { return is_chain(beyond); });
    }

    bool one_looks_ahead(const Node& node) const {
        return std::count_if(node.operands.begin(), node.operands.end(),
                             [&](NodeId operand) { return looks_ahead(operand); }) == 1;
    }

    const ir::Graph& graph_;
    ChainOperators is_;
    std::unordered_map<NodeId, bool> known_;
};

}  // namespace

std::optional<std::vector<NodeId>> beside(const ir::Graph& graph, const Node& guard, Op either) {
    const NodeId left = guard.operands[0];
    const Node& right = graph[guard.operands[1]];
    if (right.op != either) return std::nullopt;
    std::vector<NodeId> parts{left};
    if (graph[left].op == either) parts = graph[left].operands;
    std::vector<NodeId> rest;  // operands are sorted
    std::set_difference(right.operands.begin(), right.operands.end(), parts.begin(), parts.end(),
                        std::back_inserter(rest));
    const bool holds_left = rest.size() + parts.size() == right.operands.size();
    const bool without_future =
        std::none_of(rest.begin(), rest.end(), [&](NodeId part) { return graph[part].has_future; });
    return holds_left && without_future ? std::optional(rest) : std::nullopt;
}

namespace {

/// Returns what ends the wait for this formula if it lasts (chain.hpp).
std::optional<NodeId> end_of(const ir::Graph& graph, ChainOperators is, NodeId id) {
    const Node& node = graph[id];
    if (!node.has_future) return id;
    const bool lasts = node.op == is.hold() || node.op == is.guard();
    if (!lasts || node.interval != Interval{}) return std::nullopt;
    return end_of(graph, is, node.operands.back());
}

}  // namespace

std::optional<Choice> choice_of(const ir::Graph& graph, ChainOperators is, const Node& node) {
    const NodeId last = node.operands.back();
    Choice early;
    for (NodeId part : graph[last].op == is.either() ? graph[last].operands : std::vector{last})
        (graph[part].has_future ? early.beyond : early.present).push_back(part);
    const auto lasts_before = [&](NodeId id) {
        return graph[id].op == is.hold() && !graph[id].interval.bounded();
    };
    if (std::all_of(early.beyond.begin(), early.beyond.end(), lasts_before)) return early;
    const auto end = end_of(graph, is, last);
    if (!end) return std::nullopt;
    Choice late{.is_late = true, .present = {*end}};
    if (node.op == is.guard()) {
        if (graph[node.operands[0]].has_future) return std::nullopt;
        late.beyond = {last};
    }
    return late;
}

bool is_chain(const ir::Graph& graph, ChainOperators operators, NodeId id) {
    return ChainRecognition(graph, operators).is_chain(id);
}

}  // namespace etlc::plan
