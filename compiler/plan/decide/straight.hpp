// Straight-line code for formulas that a few registers settle: latches, folds and responses over
// operands without future, with the rho and bounds of the definitions on every prefix.
#pragma once

#include <cstdint>
#include <optional>

#include "plan/decide/streams.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

/// Reads a formula without future: its value at step 0, which is final.
Straight latch(StreamBuilder& streams, NodeId id);

/// Reads F or U, or the duals G and R, over operands without future: a max or min that grows while
/// the window is open.
Straight fold(StreamBuilder& streams, const ir::Node& node, NodeId id);

/// A value that counts up to a limit (in the dual: down to it).
struct Limited {
    Term value;
    Term limit;
};
/// Returns the max of min(value, limit), grouped by limit, or the dual.
Term best_of(bool max, const std::vector<Limited>& limited);

/// The answer that G waits for: without future, or in two parts.
enum class Answer : std::uint8_t { at_once, in_two };

/// Reads G[A,B] (f || F[a,b] g) or its dual F[A,B] (f && G[a,b] g), f and g without future; returns
/// nothing for other formulas. One recurrence gives the value of all positions with an open window:
/// pending = max(min(pending, f), g), true before the first position. It also settles them: the
/// window of some position closed without an answer exactly where pending stayed low for b - a + 1
/// consecutive steps, so settled = min(settled, the max of the last b - a + 1 pendings). (Both
/// sides are made of min and max, so it suffices to compare them for f and g that are true or
/// false: a run of false pendings begins with a position that asks and lasts until an answer.)
/// Without f and from every position, pending is g itself, and the body's own stream settles.
///
/// The answer may be in two parts, g = p && F[c,d] q: p begins it and q completes it. Let w be b -
/// a and e = n - d the last position at which g is settled after step n. After e a p may still be
/// completed: a position is finally missed if its window is over and has neither g up to e nor p
/// after it. Missed positions stay missed, and settled takes the min of
/// - the max of the last w + 1 pendings over g: windows up to e;
/// - windows across e. The one that begins at i asks for g in [i, e] or p in [e + 1, i + w]. With
///   p(i + w) beside g(i), all that begin in [e - w + 1, e] are good where these steps are covered
///   (etlmon/temporal/handover.hpp). If w > d the last of them are still open, and the others all
///   contain the last w - d positions up to e;
/// - if w < d, the max of the last w + 1 pendings over p: windows after e.
/// A position that is not missed, with a completed answer after it, has one in its window: if that
/// answer is later, the p in the window is still open, and the same q completes it. So one
/// recurrence again gives the open windows: pending = max(min(pending, f), min(q, f S[c,d] p)).
/// Unseen steps may bring whole answers, or q where p was seen. The latter matters only above the
/// highest unseen value of p, which must be a constant: p does not exceed it either, so it suffices
/// to ask whether an answer began since it was asked for.
std::optional<Straight> response(StreamBuilder& streams, ir::Graph& graph, NodeId id,
                                 Answer answer);

/// Reads F[A,B] (p && F[c,d] (q && ...)), with U in place of any F, or the dual: one thing after
/// the other, each within a time of the one before. One stream a phase has the best way that came
/// this far at each of the steps from which the next phase may still be reached; only the first
/// phase is tied to the positions of [A,B]. The ways of a phase that are open meet, at best, the
/// highest unseen value of what follows it, and after B nothing begins any more. Returns nothing
/// for other formulas: in every && one operand may look ahead, the left side of U may not.
std::optional<Straight> sequence(StreamBuilder& streams, ir::Graph& graph, NodeId id);

}  // namespace etlc::plan
