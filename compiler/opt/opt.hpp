// Rewrites the graph before it is planned, into an equal one that is smaller to monitor. Every pass
// keeps rho and the bounds of every monitor on every prefix. Afterwards the program is const.
#pragma once

#include <string_view>
#include <vector>

#include "ir/lower.hpp"

namespace etlc::opt {

/// Rewrites one node after its operands; returns the node itself where the rule does not apply.
using Rule = ir::NodeId (*)(ir::Graph& graph, ir::NodeId node);

struct Pass {
    std::string_view name;
    Rule rule;
    /// Applies only to formulas that prefix monitors evaluate at position 0, below && and ||: there
    /// an unbounded F or G ranges over the whole trace, so looking back from any position stays in
    /// its range.
    bool at_start_only = false;
};
const std::vector<Pass>& passes();

/// Applies every pass to every prefix monitor, then splits windows. Sliding monitors are planned as
/// written, because their delays are part of their meaning.
void optimise(ir::Program& program);

ir::NodeId distribute(ir::Graph& graph, ir::NodeId node);
ir::NodeId look_back(ir::Graph& graph, ir::NodeId node);
ir::NodeId split_until(ir::Graph& graph, ir::NodeId node);

/// Fills in program.split_windows.
void split_windows(ir::Program& program);

}  // namespace etlc::opt
