// Straight-line code for chains: formulas that wait for one thing after the other, such as
// F (a && F (b && F c)) and a U (b U c). In a chain at most one operand of every && looks ahead,
// the left one of U does not, and the right one of R only in the form of `f W g`, g R (f || g). So
// an automaton would have one obligation a state: a register each, and no product of states. Duals
// are chains too: G (a || G (b || c)), a R (b R c), G (a || F b).
//
// A register holds, as in an automaton, the best way up to the previous step with this obligation
// open. At a step, `open`, the max of the register and of the ways that arrive now, goes on to the
// parts of the obligation. Obligations are visited after those that they come from, so one step
// passes through any number of phases, and the work is in proportion to the formula. The
// transitions of an automaton list every pair of phases instead.
//
// In the dual every obligation has to be met. One that may be met in two ways, F g or p U g with a
// g that looks ahead, is part of it only where one of the ways is the best whatever follows:
// - early: F (c && F h) and p U (c && F h). An F that holds at some step holds at all steps before,
//   so once c holds there is nothing to wait for. F h may even be demanded from the beginning, as
//   it follows from the whole. So G (s -> F (a && F (b && F c))) has a register for each F.
// - late: p U g, where g without its end, q, holds at the next step too: g is f U q. g may be
// demanded as late as p fails, and the wait is over where q holds. It
//   may also last while g is demanded, because it follows from g. So p U ((r U (f U s)) U q), where
//   left and right sides look ahead in turn, has a register for each U.
// These are identities of truth values, and so of min and max, for any values beyond the prefix of
// which that of g is at most that of p U g. The unseen values are such, so bounds are the same,
// too.
#pragma once

#include <optional>
#include <vector>

#include "ir/graph.hpp"
#include "plan/decide/streams.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

/// Reads a chain or a dual, over operands without future, from unbounded intervals and delays.
/// Returns nothing for other formulas.
std::optional<Straight> chain(StreamBuilder& streams, ir::Graph& graph, NodeId id);

// The form of chains (decide/chain.hpp): which formulas are chains, and the parts of their
// operators.

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

/// The parts of a `hold` or `guard` whose right side g looks ahead.
struct Choice {
    bool is_late = false;
    std::vector<ir::NodeId> present;  ///< early: operands of c; late: what ends the wait, q
    std::vector<ir::NodeId> beyond;   ///< what looks ahead, and is demanded
};
std::optional<Choice> choice_of(const ir::Graph& graph, ChainOperators is, const ir::Node& node);

bool is_chain(const ir::Graph& graph, ChainOperators operators, ir::NodeId id);

}  // namespace etlc::plan
