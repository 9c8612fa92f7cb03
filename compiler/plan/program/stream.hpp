// Streams: a robustness for one position after the other.
// Takes: operands, which are streams before it. Gives: a row of the plan. Keeps true: after step i
// a stream tells about position i - lag, whatever the trace.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plan/program/members.hpp"

namespace etlc::plan {

enum class StreamOp : std::uint8_t {
    constant,     ///< `value`
    predicate,    ///< of the model's predicates
    flag,         ///< a bool input, by its index in the model
    negation,     ///< of a predicate or flag
    combination,  ///< max of the operands
    within,       ///< the operand at the positions of `interval`, elsewhere `value`
    delay,     ///< the operand `length` steps ago: later by `length`, so that operands of different
               ///< lag meet
    shift,     ///< the operand `length` positions earlier; `value` where there is none
    running,   ///< max over all positions so far
    window,    ///< max over the last `length` positions
    widening,  ///< the same, from the operand, which is that over fewer
    since,     ///< v = max(g, min(v, f))
    window_since,     ///< since, over the last `length` positions
    window_until,     ///< until, at the first of the last `length` positions
    window_handover,  ///< of the last `length` positions: the first operand up to some of them, the
                      ///< second from there on
};

struct Stream {
    StreamOp op = StreamOp::constant;
    bool max = true;  ///< else the dual: where the operation says max it takes the min, and so on
    std::vector<Slot> operands;
    Index index = 0;                ///< predicate or flag
    std::uint32_t length = 0;       ///< of delays, shifts, windows and widenings
    std::uint32_t from_length = 0;  ///< widening: of the operand's window
    ir::Interval interval;          ///< within: of positions
    /// constant; shift: where there is no earlier position; within: elsewhere; since, trigger:
    /// before the first position
    Value value{};
    std::uint32_t lag = 0;  ///< after step i the stream tells about position i - lag
    /// And its operands about position i - operand_lag; a constant is of any lag.
    std::uint32_t operand_lag = 0;
    /// It restarts with this monitor, by index in the plan, and counts positions from there;
    /// kNone: with the trace.
    std::uint32_t begins_with = kNone;
    NodeId node = kNone;      ///< the formula it is, for comments; kNone for the values in between,
    std::string_view called;  ///< which may have a name
    std::string_view holds;   ///< and a comment
};

std::vector<Member> members_of(const Stream& stream);

/// The formula that a stream is; of one in between, what it holds; empty where its operation says
/// that.
std::string text_of(const Stream& stream, const ir::Graph& formulas);

}  // namespace etlc::plan
