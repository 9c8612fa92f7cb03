// What a plan computes: streams, readings, the terms that readings compute, and their members.
//
// Readings: rho of prefix monitors at the position where they began, and its bounds over every
// continuation. Every reading is straight-line code, a table, a formula over the last positions, or
// a max or min of readings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "check/model/model.hpp"
#include "etlmon/temporal/machine.hpp"
#include "etlmon/temporal/value.hpp"
#include "ir/graph.hpp"

namespace etlc::plan {

// Terms: minima and maxima over streams, registers and constants, which readings compute at every
// step. Neutral constants are dropped, absorbing ones replace the whole, and no max is an operand
// of a max, so equal bounds are mostly equal terms.

using check::Index;
using check::kNone;
using check::kUnbounded;
using etlmon::Key;
using etlmon::Value;
using Slot = std::uint32_t;  ///< index of a stream

/// Returns the max of nothing; for a dual, whose max is a min, the min of nothing.
constexpr Value neutral(bool max) {
    return max ? etlmon::kFalse : etlmon::kTrue;
}

/// The end of a value that counts: the low end for a lower bound, the high end for an upper bound.
enum class End : std::uint8_t { both, low, high };

struct Term {
    enum class Kind : std::uint8_t {
        constant,  ///< `value`
        stream,    ///< of this slot
        reg,       ///< a register of the reading
        local,     ///< the result of an earlier assignment of this step
        extreme,   ///< the max or min of at least two operands
        before,    ///< the first operand before position `index`, then the second
    };
    Kind kind = Kind::constant;
    bool max = true;  ///< of an extreme; else the min
    std::uint32_t index = 0;
    Value value{};
    std::vector<Term> operands;

    static Term constant(Value value);
    static Term stream(Slot slot);
    static Term reg(std::size_t index);
    static Term local(std::size_t index);
    /// Returns the extreme of any number of terms.
    static Term extreme(bool max, std::vector<Term> operands);
    static Term before(std::uint32_t position, Term inside, Term after);
};

bool operator==(const Term& a, const Term& b);

/// Returns the number of binary minima and maxima of a term.
std::size_t combinations(const Term& term);
/// Returns whether the term reads the position of the step.
bool asks_position(const Term& term);

/// Calls visit(slot) for every stream that is read; the slot of a mutable term is mutable.
template <class T, class Visit>
void for_each_slot_of(T& term, const Visit& visit) {
    if (term.kind == Term::Kind::stream) visit(term.index);
    for (auto& operand : term.operands) for_each_slot_of(operand, visit);
}

// The members that a stream or a reading keeps from one step to the next.
// Takes: a part of the plan. Gives: its members in order of declaration, each with what it is, its
// first value, its name's end and its comment. Keeps true: the class that is emitted has these
// members, the evaluator has these states, and the budget is the sum of their bytes.

using ir::NodeId;

struct Member {
    enum class Kind : std::uint8_t {
        value,            ///< one
        variable,         ///< one, that the runtime is given to change
        delay,            ///< the last `length` values
        window,           ///< a sliding aggregate over the last `length`
        since_window,     ///< the same of two signals
        until_window,     ///< the same towards the future
        count_window,     ///< the n-th greatest of the last `length`, n being `count`
        handover_window,  ///< the same of two signals that meet
        widening,         ///< what a window of `length` adds to one of `from_length`
        machine,          ///< `length` registers, and those of the next step
        recent,           ///< the last `length` values, in order
        pending_machine,  ///< `length` registers, with `guards`
    };
    Kind kind = Kind::value;
    bool max = true;  ///< of aggregates; else the dual
    std::uint32_t length = 0;
    std::uint32_t from_length = 0;
    std::uint32_t guards = 0;
    std::uint32_t count = 0;
    Value first{};         ///< of values and delays
    std::string suffix{};  ///< what its name has behind that of its reading: "_guard"
    // The comment is these words around the formulas.
    std::string before{};
    std::vector<NodeId> formulas{};
    std::string after{};
};

/// In the class, with values of this type.
std::uint64_t bytes_of(const Member& member, check::Values values);

std::string comment_of(const Member& member, const ir::Graph& formulas);

/// Assigns a register or local, at the positions of the interval.
struct Assignment {
    Term::Kind target = Term::Kind::reg;  ///< reg or local
    std::uint32_t index = 0;
    ir::Interval positions{};
    Term value;
};

/// Straight-line code: the assignments in this order, then the reading.
struct Straight {
    std::vector<Member> registers;
    std::vector<std::string> locals;  ///< ends of their names, after that of the reading
    std::vector<Assignment> assignments;
    Term rho;
    Term lower;  ///< the low end counts
    Term upper;  ///< the high end counts
};

/// A weighted automaton over (max, min), as constant tables of etlmon/temporal/machine.hpp.
struct Table {
    std::vector<etlmon::Transition> transitions;
    std::vector<std::uint32_t> ends;        ///< per state
    std::vector<etlmon::Obligations> owed;  ///< per state
    /// Streams whose low ends are the weak keys, and whose high ends are the strong keys, from
    /// index 1; index 0 is kTop.
    std::vector<Slot> weak;
    std::vector<Slot> strong;
    /// Per guard, its operands, of which it is the min: streams, or parts of a pending reading.
    std::vector<std::vector<std::uint32_t>> guards;
    std::vector<std::vector<NodeId>> obligations;  ///< per state, for people
};

/// An operator or a table over formulas with a bounded future. These are settled `horizon` steps
/// late; later positions are evaluated again at every step on the current prefix
/// (etlmon/temporal/pending.hpp), starting from the registers of the last settled position.
struct Pending {
    struct Part {
        NodeId node = kNone;
        Slot leaf = kNone;  ///< a formula without future, else:
        bool max = true;    ///< ||, F or U; else the dual
        ir::Interval interval;
        std::vector<std::uint32_t> operands;  ///< parts
        Slot unseen = kNone;  ///< of temporal operators: unseen values of the last operand
    };
    std::vector<Part> parts;  ///< operands first
    std::uint32_t horizon = 0;
    bool is_fold = true;
    Part fold;    ///< is_fold: from position 0
    Table table;  ///< else
};

struct Reading {
    enum class Kind : std::uint8_t { straight, table, pending, combination };
    Kind kind = Kind::straight;
    NodeId node = 0;
    std::string as;  ///< name for people: "fold"
    /// The monitor, by index in the plan, that it restarts with and counts positions from; kNone:
    /// the trace.
    std::uint32_t begins_with = kNone;
    Straight straight;
    Table table;
    Pending pending;
    bool max = true;                      ///< of a combination: max of the operands, else min
    std::vector<std::uint32_t> operands;  ///< readings of a combination
};

std::vector<Member> members_of(const Reading& reading);

/// Returns whether the reading uses the number of the step.
bool asks_position(const Reading& reading);

/// Returns the table of a reading, if it has one.
const Table* table_of(const Reading& reading);

/// Calls visit(slot) for every stream that a reading reads; the slot of a mutable reading is
/// mutable.
template <class R, class Visit>
void for_each_slot(R& reading, const Visit& visit) {
    const auto if_any = [&](auto& slot) {
        if (slot != kNone) visit(slot);
    };
    const auto keys = [&](auto& table) {
        for (auto& slot : table.weak) visit(slot);
        for (auto& slot : table.strong) visit(slot);
    };
    switch (reading.kind) {
        case Reading::Kind::straight:
            for (auto& assignment : reading.straight.assignments)
                for_each_slot_of(assignment.value, visit);
            for_each_slot_of(reading.straight.rho, visit);
            for_each_slot_of(reading.straight.lower, visit);
            for_each_slot_of(reading.straight.upper, visit);
            break;
        case Reading::Kind::table:
            for (auto& guard : reading.table.guards)
                for (auto& slot : guard) visit(slot);
            keys(reading.table);
            break;
        case Reading::Kind::pending:
            for (auto& part : reading.pending.parts) {
                if_any(part.leaf);
                if_any(part.unseen);
            }
            if_any(reading.pending.fold.unseen);
            keys(reading.pending.table);
            break;
        case Reading::Kind::combination: break;
    }
}

// A stream gives a robustness for one position after the other: after step i it gives that of
// position i - lag, whatever the trace.

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
