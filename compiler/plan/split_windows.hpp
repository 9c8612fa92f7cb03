// Windows over an unbounded future, taken apart.
// Takes: a formula of the graph. Gives: an equal one, in which bounded operators look at an
// unbounded future only from the end of their window, and that step is pushed down to what has a
// bounded future. Keeps true: rho on every prefix, and bounds at least as tight as the
// definition's; gives the formula itself where there is nothing to split, or where the parts would
// be too many.
//
// An automaton counts such windows down: F[0,40] (p U q) is 41 obligations, and under G it is sets
// of them. Apart, the unbounded operators alone make the automaton, over literals whose future is
// bounded (`Pending`).
#pragma once

#include "ir/graph.hpp"

namespace etlc::plan {

ir::NodeId split_windows(ir::Graph& graph, ir::NodeId formula);

}  // namespace etlc::plan
