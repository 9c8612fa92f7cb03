// Rewriting the graph before it is planned.
// Takes: the program. Gives: an equal one that is smaller to monitor. Keeps true: rho and the
// bounds of every monitor on every prefix; the passes stand in one table. Behind here the program
// is const.
#pragma once

#include <string_view>
#include <vector>

#include "ir/lower.hpp"

namespace etlc::opt {

/// Rewrites one node whose operands are rewritten already; gives the node itself where the pass has
/// nothing to say.
using Rule = ir::NodeId (*)(ir::Graph& graph, ir::NodeId node);

struct Pass {
    std::string_view name;
    Rule rule;
    /// Only formulas that prefix monitors evaluate at position 0, below && and ||: there an
    /// unbounded F or G ranges over the whole trace, so that looking back from any position reaches
    /// no position that it would not have reached.
    bool at_start_only = false;
};
const std::vector<Pass>& passes();

/// Applies every pass to every prefix monitor, and then takes windows apart. Sliding monitors are
/// planned as written: their delays are their meaning.
void optimise(ir::Program& program);

ir::NodeId distribute(ir::Graph& graph, ir::NodeId node);
ir::NodeId look_back(ir::Graph& graph, ir::NodeId node);
ir::NodeId split_until(ir::Graph& graph, ir::NodeId node);

/// Fills in program.split_windows.
void split_windows(ir::Program& program);

}  // namespace etlc::opt
