// A state machine as the constant tables of etlmon/temporal/machine.hpp.
// Takes: a machine of the plan. Gives: its tables, and which streams fill the lists of keys at each
// step. Keeps true: the evaluator and the generated code run the same tables.
#pragma once

#include <vector>

#include "etlmon/temporal/machine.hpp"
#include "plan/plan.hpp"

namespace etlc::plan {

struct Table {
    std::vector<etlmon::Transition> transitions;
    std::vector<std::uint32_t> ends;  ///< per state
    std::vector<etlmon::Owed> owed;   ///< per state
    std::vector<Slot>
        weak;  ///< streams whose low ends are the weak keys from index 1 on; index 0 is kTop
    std::vector<Slot>
        strong;  ///< streams whose high ends are the strong keys from index 1 on; index 0 is kTop
};

Table make_table(const Machine& machine);

}  // namespace etlc::plan
