// A stream gives a robustness for one position after the other: after step i it gives that of
// position i - lag, whatever the trace.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plan/program/members.hpp"

namespace etlc::plan {

enum class StreamOp : std::uint8_t {
    constant,         ///< `value`
    predicate,        ///< of the model's predicates
    flag,             ///< a bool input, by its index in the model
    negation,         ///< of a predicate or flag
    combination,      ///< max of the operands
    within,           ///< the operand at the positions of `interval`, elsewhere `value`
    delay,            ///< the operand delayed by `length` steps, to align operands of different lag
    shift,            ///< the operand `length` positions earlier; `value` where there is none
    running,          ///< max over all positions so far
    window,           ///< max over the last `length` positions
    widening,         ///< the same, from a shorter window, which is the operand
    since,            ///< v = max(g, min(v, f))
    window_since,     ///< since, over the last `length` positions
    window_until,     ///< until, at the first of the last `length` positions
    window_count,     ///< whether the operand holds at `index` or more of the last `length`
                      ///< positions: the n-th greatest value; the dual is the n-th least
    window_handover,  ///< over the last `length` positions: the first operand up to some position,
                      ///< the second after it
};

struct Stream {
    StreamOp op = StreamOp::constant;
    bool max = true;  ///< else the dual, with min for max and so on
    std::vector<Slot> operands;
    Index index = 0;                ///< predicate or flag; n of a count
    std::uint32_t length = 0;       ///< of delays, shifts, windows and widenings
    std::uint32_t from_length = 0;  ///< widening: of the operand's window
    ir::Interval interval;          ///< within: of positions
    /// constant; shift: where there is no earlier position; within: elsewhere; since, trigger:
    /// before the first position
    Value value{};
    std::uint32_t lag = 0;  ///< after step i the value is that of position i - lag
    /// The operands give position i - operand_lag; a constant has any lag.
    std::uint32_t operand_lag = 0;
    /// The monitor, by index in the plan, that it restarts with and counts positions from; kNone:
    /// the trace.
    std::uint32_t begins_with = kNone;
    NodeId node = kNone;      ///< its formula, for comments; kNone for intermediate values,
    std::string_view called;  ///< which may have a name instead
    std::string_view holds;   ///< and a comment
};

std::vector<Member> members_of(const Stream& stream);

/// Returns the formula of a stream, or the comment of an intermediate one; empty where its
/// operation says enough.
std::string text_of(const Stream& stream, const ir::Graph& formulas);

}  // namespace etlc::plan
