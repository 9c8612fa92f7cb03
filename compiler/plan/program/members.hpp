// The members that a stream or a reading keeps from one step to the next.
// Takes: a part of the plan. Gives: its members in order of declaration, each with what it is, its
// first value, its name's end and its comment. Keeps true: the class that is emitted has these
// members, the evaluator has these states, and the budget is the sum of their bytes.
#pragma once

#include <string>
#include <vector>

#include "ir/graph.hpp"
#include "plan/program/term.hpp"

namespace etlc::plan {

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

}  // namespace etlc::plan
