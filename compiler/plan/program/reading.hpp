// Readings: rho of prefix monitors at the position where they began, and its bounds over every
// continuation. Every reading is straight-line code, a table, a formula over the last positions, or
// a max or min of readings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "etlmon/temporal/machine.hpp"
#include "plan/program/members.hpp"

namespace etlc::plan {

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

}  // namespace etlc::plan
