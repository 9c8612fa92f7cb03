#include "explain/values.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "etlmon/temporal/pending.hpp"
#include "etlmon/temporal/shift.hpp"

namespace etlc::explain {

namespace {

constexpr std::int64_t kFirst = std::int64_t{1} << 62;

Sourced sourced(etlmon::Key key, std::uint64_t sample) {
    const std::int64_t rank = kFirst - static_cast<std::int64_t>(sample);
    return {key, key < 0 ? -rank : rank};
}

using Lattice = etlmon::Lattice<Bounds>;

/// The last values in order, of which the n-th greatest is asked for, or the n-th least.
class Sorted {
public:
    void add(Sourced value) {
        values_.insert(std::upper_bound(values_.begin(), values_.end(), value), value);
    }
    void remove(Sourced value) {
        values_.erase(std::lower_bound(values_.begin(), values_.end(), value));
    }
    Sourced nth(bool max, std::size_t n) const {
        if (n > values_.size()) return max ? kFalseItself : kTrueItself;
        return max ? values_[values_.size() - n] : values_[n - 1];
    }

private:
    std::vector<Sourced> values_;
};

Bounds best_of(bool max, Bounds a, Bounds b) {
    return max ? max_of(a, b) : min_of(a, b);
}

}  // namespace

std::vector<bool> closure(const ir::Graph& graph, const std::vector<NodeId>& roots) {
    std::vector<bool> result(graph.size());
    for (const NodeId root : roots) result[root] = true;
    for (std::size_t id = graph.size(); id-- > 0;)
        if (result[id])
            for (const NodeId operand : graph[static_cast<NodeId>(id)].operands)
                result[operand] = true;
    return result;
}

Values::Values(const ir::Graph& graph, const std::vector<bool>& nodes,
               const Observations& observations, std::uint64_t last, Semantics semantics,
               const Altered* altered)
    : graph_(&graph),
      observations_(&observations),
      atoms_(observations.atoms().size()),
      seen_(last + 1),
      semantics_(semantics),
      values_(nodes.size()) {
    for (NodeId id = 0; id < nodes.size(); ++id) {
        if (!nodes[id]) continue;
        const ir::Node& node = graph[id];
        if (ir::info(node.op).tense != ir::Tense::now) {
            values_[id] = temporal(node);
            continue;
        }
        values_[id].resize(seen_ + (semantics == Semantics::for_good ? 1 : 0));
        for (std::size_t t = 0; t < values_[id].size(); ++t)
            values_[id][t] =
                node.operands.empty() ? constant_or_literal(node, t, altered) : combined(node, t);
    }
}

std::optional<Sample> Values::source(Sourced value) const {
    const std::int64_t rank = value.rank < 0 ? -value.rank : value.rank;
    if (rank > kFirst) return std::nullopt;
    const auto sample = static_cast<std::uint64_t>(kFirst - rank);
    if (sample / atoms_ >= seen_) return std::nullopt;
    return Sample{static_cast<Index>(sample % atoms_), sample / atoms_};
}

Bounds Values::constant_or_literal(const ir::Node& node, std::size_t step,
                                   const Altered* altered) const {
    if (node.op == ir::Op::constant_true) return Lattice::top();
    if (node.op == ir::Op::constant_false) return Lattice::bottom();
    const Index atom = observations_->atom(node.op == ir::Op::predicate, node.index);
    const bool is_altered = altered != nullptr && altered->step == step && altered->is_of(atom);
    const etlmon::Value value = step == seen_ ? observations_->range(atom)
                                : is_altered  ? observations_->value(atom, altered->measured)
                                              : observations_->value({atom, step});
    const std::uint64_t sample = step * atoms_ + atom;
    const Bounds found{sourced(value.low, sample), sourced(value.high, sample)};
    return node.negated ? Bounds{-found.upper, -found.lower} : found;
}

Bounds Values::combined(const ir::Node& node, std::size_t position) const {
    Bounds result = values_[node.operands.front()][position];
    for (const NodeId operand : node.operands)
        result = best_of(node.op == ir::Op::disjunction, result, values_[operand][position]);
    return result;
}

/// Returns the n-th greatest of the last values at each position, or the n-th least.
Values::Column Values::counted(const ir::Node& node) const {
    const Column& operand = values_[node.operands[0]];
    const bool max = ir::takes_max(node.op);
    const std::size_t length = node.interval.high + std::size_t{1};
    Sorted lower;
    Sorted upper;
    Column result;
    for (std::size_t k = 0; k < seen_; ++k) {
        lower.add(operand[k].lower);
        upper.add(operand[k].upper);
        if (k >= length) {
            lower.remove(operand[k - length].lower);
            upper.remove(operand[k - length].upper);
        }
        result.push_back({lower.nth(max, node.index), upper.nth(max, node.index)});
    }
    if (semantics_ == Semantics::for_good) result.push_back(unseen(node));
    return result;
}

Values::Column Values::temporal(const ir::Node& node) const {
    if (ir::counts(node.op)) return counted(node);
    const bool past = ir::info(node.op).tense == ir::Tense::past;
    // The past is the future of the trace backwards.
    const auto in_order = [&](Column column) {
        column.resize(seen_);
        if (past) std::reverse(column.begin(), column.end());
        return column;
    };
    const Column last = in_order(values_[node.operands.back()]);
    const Column left =
        node.operands.size() == 2 ? in_order(values_[node.operands.front()]) : Column{};
    const bool is_open = !past && semantics_ == Semantics::for_good;
    const Bounds to_come = is_open ? values_[node.operands.back()].back() : Bounds{};
    Column result(seen_);
    const auto evaluate = [&](auto sense, Sourced unseen) {
        etlmon::pending_at_each<decltype(sense)>(left.empty() ? nullptr : left.data(), last.data(),
                                                 result.data(), static_cast<std::uint32_t>(seen_),
                                                 node.interval.low, node.interval.high, unseen);
    };
    if (ir::takes_max(node.op))
        evaluate(etlmon::Seeking(), is_open ? to_come.upper : kFalseItself);
    else
        evaluate(etlmon::Guarding(), is_open ? to_come.lower : kTrueItself);
    result = in_order(std::move(result));
    if (semantics_ == Semantics::for_good) result.push_back(unseen(node));
    return result;
}

/// Returns the lowest and highest unseen value of a temporal operator, as docs/semantics.md defines
/// them.
Bounds Values::unseen(const ir::Node& node) const {
    const bool max = ir::takes_max(node.op);
    const Column& operand = values_[node.operands.back()];
    const Bounds next = operand.back();
    Bounds ever = next;
    if (ir::info(node.op).tense == ir::Tense::past)
        for (const Bounds& known : operand) ever = best_of(max, ever, known);
    const bool never_forgets = node.operands.size() == 1 && !node.interval.bounded();
    const bool may_lack = node.interval.low > 0 || ir::counts(node.op);
    const Bounds kept = may_lack        ? (max ? Lattice::bottom() : Lattice::top())
                        : never_forgets ? ever
                                        : next;
    return max ? Bounds{kept.lower, ever.upper} : Bounds{ever.lower, kept.upper};
}

// ---- with other measurements --------------------------------------------------------------------

Bounds Values::at_with(const Altered& altered, NodeId node, std::uint64_t position) {
    changed_.resize(node + std::size_t{1});
    for (NodeId id = 0; id <= node; ++id)
        if (has(id)) alter(id, altered);
    const Bounds result = at(node, position);
    for (; !before_.empty(); before_.pop_back()) {
        const Before& was = before_.back();
        values_[was.node][was.position] = was.value;
        changed_[was.node].clear();
    }
    return result;
}

void Values::set(NodeId node, std::size_t position, Bounds value) {
    Bounds& now = values_[node][position];
    if (now == value) return;
    before_.push_back({node, position, now});
    changed_[node].push_back(position);
    now = value;
}

/// Evaluates a node again whose operands are altered.
void Values::alter(NodeId id, const Altered& altered) {
    const ir::Node& node = (*graph_)[id];
    if (node.operands.empty())
        return set(id, altered.step, constant_or_literal(node, altered.step, &altered));
    if (ir::info(node.op).tense == ir::Tense::now) {
        for (const NodeId operand : node.operands)
            for (const std::size_t position : changed_[operand])
                set(id, position, combined(node, position));
        return;
    }
    if (std::all_of(node.operands.begin(), node.operands.end(),
                    [&](NodeId operand) { return changed_[operand].empty(); }))
        return;
    const Column column = temporal(node);
    for (std::size_t t = 0; t < column.size(); ++t) set(id, t, column[t]);
}

// ---- the verdict --------------------------------------------------------------------------------

etlmon::Key Subject::end_of(etlmon::Key key, float shift) {
    return std::isinf(shift) ? -etlmon::key_of(shift) : etlmon::shifted(key, shift);
}

bool Subject::supports(Status status, etlmon::Key key) const {
    return status == Status::satisfied ? end_of(key, low_shift) >= 0 : end_of(key, high_shift) < 0;
}

/// A verdict that is final holds so far as well.
Judged judge(const Subject& subject, const Altered* altered) {
    const auto judged = [&](Semantics semantics) {
        Values values(subject.graph, subject.nodes, subject.observations, subject.last, semantics,
                      altered);
        const Bounds root = values.at(subject.root, subject.position);
        const Status status =
            subject.supports(Status::satisfied, root.lower.key)  ? Status::satisfied
            : subject.supports(Status::violated, root.upper.key) ? Status::violated
                                                                 : Status::unknown;
        return Judged{status, semantics, std::move(values)};
    };
    if (Judged for_good = judged(Semantics::for_good); for_good.status != Status::unknown)
        return for_good;
    return judged(Semantics::so_far);
}

}  // namespace etlc::explain
