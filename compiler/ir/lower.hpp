// Lowers typed formulas into the graph: in negation normal form, with derived operators written
// out. Each formula is lowered at most once per polarity, so shared `let`s stay shared.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "ir/graph.hpp"

namespace etlc::ir {

struct Program {
    Graph graph;
    std::vector<NodeId> monitors;  ///< per monitor of the model
    std::vector<NodeId> lets;      ///< per let of the model; kNone where it is no telemetry
    /// For some formulas an equal one, whose windows end before an unbounded future begins; the
    /// plan takes the cheaper one (opt/split_windows.cpp).
    std::unordered_map<NodeId, NodeId> split_windows;
    /// The node of each formula of the model and, at [1], of its negation; kNone where no monitor
    /// needs it.
    std::array<std::vector<NodeId>, 2> formulas;
};

/// Prints every node that a monitor or a let reaches, operands first: `--emit graph`.
std::string print(const Program& program);

Program lower(const check::Model& model);

}  // namespace etlc::ir
