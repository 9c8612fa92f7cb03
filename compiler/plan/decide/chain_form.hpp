// The form of chains (decide/chain.hpp): which formulas are chains, and the parts of their
// operators.
#pragma once

#include <optional>
#include <vector>

#include "ir/graph.hpp"

namespace etlc::plan {

/// The operators of a chain whose ways are joined by max. Its dual exchanges each pair.
struct ChainOperators {
    using Op = ir::Op;
    bool max = true;

    Op either() const { return max ? Op::disjunction : Op::conjunction; }
    Op both() const { return max ? Op::conjunction : Op::disjunction; }
    Op seek() const { return max ? Op::eventually : Op::always; }
    Op hold() const { return max ? Op::always : Op::eventually; }
    Op wait() const { return max ? Op::until : Op::release; }
    Op guard() const { return max ? Op::release : Op::until; }
    /// Returns whether an obligation that is open at the end of the prefix is false (in the dual:
    /// true), so that the value leaves it out.
    bool is_owed(Op op) const { return ir::takes_max(op) == max; }
};

/// Returns what a `guard` demands besides its left side, which looks ahead, as in g R (f || g): the
/// operands of f. Returns nothing where its right side has another form.
std::optional<std::vector<ir::NodeId>> beside(const ir::Graph& graph, const ir::Node& guard,
                                              ir::Op either);

bool is_chain(const ir::Graph& graph, ChainOperators operators, ir::NodeId id);

}  // namespace etlc::plan
