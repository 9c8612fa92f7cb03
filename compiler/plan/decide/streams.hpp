// Builds streams, the part of the plan that evaluates formulas at every position. The stream of a
// formula lags by its horizon: without future it is known at once, with a bounded future when its
// last sample is there. Equal streams are built once; operands come before their users.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "check/model/model.hpp"
#include "plan/budget/budget.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

class StreamBuilder {
public:
    StreamBuilder(const ir::Graph& graph, std::vector<Stream>& streams, check::Values values)
        : graph_(graph), streams_(streams), values_(values) {}

    /// Returns the stream of rho(node, k, i) at k = i - lag, lag being the node's bounded horizon.
    Slot of(NodeId node);
    /// Returns the lowest and highest unseen value of a formula after this step, as the definition
    /// "Bounds over every continuation" gives them; constant unless an unbounded past operator
    /// narrows them.
    Slot unseen(NodeId node);
    /// Returns the max or min of streams of equal lag; folds constants.
    Slot combine(bool max, std::vector<Slot> operands, NodeId node = kNone);
    /// Returns the stream delayed by `steps`.
    Slot delayed(Slot slot, std::uint32_t steps);

    /// Returns one end of a stream, or both, as a term.
    Term term(Slot slot, End end = End::both) const;
    /// Returns whether the stream is evaluated on demand (plan/budget/budget.hpp).
    bool on_demand(Slot slot) const { return on_demand_[slot]; }

    Slot constant(Value value);

    // Streams that readings add start with this monitor, or with the trace.
    void begin_with(std::uint32_t monitor) { begins_with_ = monitor; }
    std::uint32_t begins_with() const { return begins_with_; }
    /// Returns a stream without lag `steps` positions earlier, `before` where there is none.
    Slot earlier(Slot slot, std::uint32_t steps, Value before) {
        return shift(slot, steps, 0, before, kNone, begins_with_);
    }
    /// Returns a stream without lag at the positions of the interval, `elsewhere` at others.
    Slot within(Slot slot, ir::Interval interval, Value elsewhere) {
        return within(slot, interval, elsewhere, begins_with_);
    }
    /// Returns the value of open windows that wait for `answer`, unless `excuse` holds
    /// (decide/straight.hpp): of G (excuse || F answer), or of its dual; both without lag.
    Slot pending(bool of_always, Slot excuse, Slot answer);
    /// Returns the max or min over the last `length` positions of a stream without lag, or over all
    /// for kUnbounded.
    Slot recent(bool max, Slot slot, std::uint32_t length);
    /// Returns left S[a,b] right over streams without lag, or the dual.
    Slot since(bool max, Slot left, Slot right, ir::Interval interval);
    /// Returns the best handover from `before` to `behind` in the last `length` positions, or the
    /// dual (etlmon/temporal/handover.hpp); both without lag.
    Slot handover(bool max, Slot before, Slot behind, std::uint32_t length);
    /// Names a stream without a formula for people; name and comment outlive the plan.
    Slot call(Slot slot, std::string_view name, std::string_view holds);
    bool is_constant(Slot slot) const { return streams_[slot].op == StreamOp::constant; }

private:
    Slot intern(Stream stream);
    Slot literal(const ir::Node& node, NodeId id);
    Slot aligned_combination(const ir::Node& node, NodeId id);
    Slot past_unary(const ir::Node& node, NodeId id);
    Slot past_binary(const ir::Node& node, NodeId id);
    Slot count(const ir::Node& node, NodeId id);
    /// Returns the stream `steps` positions earlier, `before` where there is none.
    Slot shift(Slot slot, std::uint32_t steps, std::uint32_t lag, Value before, NodeId node,
               std::uint32_t begins_with);
    Slot within(Slot slot, ir::Interval interval, Value elsewhere, std::uint32_t begins_with);
    Slot since(bool max, const std::vector<Slot>& operands, ir::Interval interval,
               std::uint32_t lag, NodeId node, std::uint32_t begins_with);
    Slot future_unary(const ir::Node& node, NodeId id);
    Slot future_binary(const ir::Node& node, NodeId id);
    Slot window(StreamOp op, bool max, std::vector<Slot> operands, std::uint32_t length,
                std::uint32_t operand_lag, std::uint32_t lag, NodeId node,
                std::uint32_t begins_with = kNone);
    Slot running(bool max, Slot slot, NodeId node, std::uint32_t begins_with = kNone);
    std::vector<Slot> align(const std::vector<NodeId>& nodes);
    Slot unseen_temporal(const ir::Node& node, NodeId id);

    const ir::Graph& graph_;
    std::vector<Stream>& streams_;
    check::Values values_;
    std::uint32_t begins_with_ = kNone;
    std::vector<bool> on_demand_;  ///< per stream
    std::map<NodeId, Slot> slots_;
    std::map<NodeId, Slot> unseen_;
    using Identity =
        std::tuple<StreamOp, bool, std::vector<Slot>, Index, std::uint32_t, Key, Key, std::uint32_t,
                   std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
    std::map<Identity, Slot> interned_;
};

}  // namespace etlc::plan
