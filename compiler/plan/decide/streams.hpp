// Formulas as streams: the part of the plan that runs at every step for every position.
// Takes: nodes of the graph. Gives: slots of streams; a stream of node f lags by f's horizon, so a
// formula without future is known at once and a bounded future one as soon as its last sample is
// there. Keeps true: equal streams stand once; operands stand before what uses them.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "check/model/model.hpp"
#include "plan/program/demand.hpp"
#include "plan/program/stream.hpp"

namespace etlc::plan {

class StreamBuilder {
public:
    StreamBuilder(const ir::Graph& graph, std::vector<Stream>& streams, check::Values values)
        : graph_(graph), streams_(streams), values_(values) {}

    /// The stream of rho(node, k, i) at k = i - lag, lag = the node's horizon, which is bounded.
    Slot of(NodeId node);
    /// The lowest and highest unseen value of a formula, as the definition "Bounds over every
    /// continuation" gives them after this step; constant unless an unbounded past operator narrows
    /// them.
    Slot unseen(NodeId node);
    /// The max or min of streams of equal lag; constants are folded.
    Slot combine(bool max, std::vector<Slot> operands, NodeId node = kNone);
    /// The same stream, later by `steps`.
    Slot delayed(Slot slot, std::uint32_t steps);

    /// What a stream is at one end, or both.
    Term term(Slot slot, End end = End::both) const;
    /// The stream is found out when it is asked for (plan/program/demand.hpp).
    bool on_demand(Slot slot) const { return on_demand_[slot]; }

    Slot constant(Value value);
    /// The stream `steps` positions earlier, `before` where there is none.
    Slot shift(Slot slot, std::uint32_t steps, std::uint32_t lag, Value before, NodeId node);
    /// A stream without lag at the positions of the interval, `elsewhere` at others.
    Slot within(Slot slot, ir::Interval interval, Value elsewhere);
    /// What open windows say that wait for `answer`, where `excuse` speaks for the positions that
    /// ask (decide/straight.hpp). Of G (excuse || F answer), or of its dual; both without lag.
    Slot pending(bool of_always, Slot excuse, Slot answer);
    /// The max or min over the last `length` positions of a stream without lag.
    Slot recent(bool max, Slot slot, std::uint32_t length);

private:
    Slot intern(Stream stream);
    Slot literal(const ir::Node& node, NodeId id);
    Slot aligned_combination(const ir::Node& node, NodeId id);
    Slot past_unary(const ir::Node& node, NodeId id);
    Slot past_binary(const ir::Node& node, NodeId id);
    Slot future_unary(const ir::Node& node, NodeId id);
    Slot future_binary(const ir::Node& node, NodeId id);
    Slot window(StreamOp op, bool max, std::vector<Slot> operands, std::uint32_t length,
                std::uint32_t operand_lag, std::uint32_t lag, NodeId node);
    Slot running(bool max, Slot slot, NodeId node);
    std::vector<Slot> align(const std::vector<NodeId>& nodes);
    Slot unseen_temporal(const ir::Node& node, NodeId id);

    const ir::Graph& graph_;
    std::vector<Stream>& streams_;
    check::Values values_;
    std::vector<bool> on_demand_;  ///< per stream
    std::map<NodeId, Slot> slots_;
    std::map<NodeId, Slot> unseen_;
    using Identity = std::tuple<StreamOp, bool, std::vector<Slot>, Index, std::uint32_t, Key, Key,
                                std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
    std::map<Identity, Slot> interned_;
};

}  // namespace etlc::plan
