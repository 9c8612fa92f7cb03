#include "plan/decide/chain_form.hpp"

#include <algorithm>
#include <iterator>
#include <unordered_map>

namespace etlc::plan {

using ir::Interval;
using ir::Node;
using ir::NodeId;
using ir::Op;

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
        if (node.op == is_.hold()) return !looks_ahead(last);
        if (is_delay) return false;
        if (node.op == is_.wait()) return !looks_ahead(node.operands[0]) && is_chain(last);
        const bool fits = !looks_ahead(last) || beside(graph_, node, is_.either()).has_value();
        return fits && is_chain(node.operands[0]);
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

bool is_chain(const ir::Graph& graph, ChainOperators operators, NodeId id) {
    return ChainRecognition(graph, operators).is_chain(id);
}

}  // namespace etlc::plan
