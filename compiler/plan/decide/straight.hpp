// Formulas that a few registers settle, as straight-line code.
// Takes: nodes of the graph whose operands have no future, and their streams. Gives: the code of a
// latch, a fold or a response. Keeps true: rho and the bounds of the definitions, on every prefix.
#pragma once

#include <optional>

#include "plan/decide/streams.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

/// A formula without future at the top: its value at step 0, for good.
Straight latch(StreamBuilder& streams, NodeId id);

/// F or U, or the duals G and R, over operands without future: a max or min that grows while the
/// window is open.
Straight fold(StreamBuilder& streams, const ir::Node& node, NodeId id);

/// G[A,B] (f || F[a,b] g) or its dual F[A,B] (f && G[a,b] g), f and g without future; nothing for
/// other formulas. What the positions whose window is still open say is one recurrence, pending =
/// max(min(pending, f), g), true before the first position. And they are settled by the same value:
/// the window of some position passed without an answer exactly where pending stayed low for b - a
/// + 1 steps on end, so settled = min(settled, the max of the last b - a + 1 pendings). (Both sides
/// are made of min and max, so it is enough to compare them where f and g are only true or false: a
/// run of false pendings begins with a position that asks and lasts until an answer.) Without f and
/// from every position, pending is g itself and the body's own stream settles.
///
/// The answer may be in two parts, F[a,b] (p && F[c,d] q) and the dual: p begins it and q completes
/// it. After step n it is settled at the positions up to e = n - d; call it g there. At those
/// since, p may still be completed, so that a position is surely missed where its window is over
/// and has neither g up to e nor p behind. Once missed is missed, and settled keeps the min of
/// - the max of the last b - a + 1 pendings over g: windows up to e;
/// - the windows across e: with their i and i + (b - a) in step, those that begin at i = e - (b -
/// a)
///   + 1, ..., e ask for g in [i, e] or p in [e + 1, i + b - a], a covered interval
///   (etlmon/temporal/handover.hpp). Where b - a > d the last of them are not over yet, and the
///   others all reach over the positions up to e;
/// - where b - a < d, the max of the last b - a + 1 pendings over p: windows behind e.
/// What is not missed and has some completed answer behind it has one in time: if that is beyond
/// the window, the p in the window is not settled and is completed by the same q. So what the
/// positions whose window is still open say is again one recurrence, over answers as they are
/// completed: pending = max(min(pending, f), min(q, f S[c,d] p)). For the upper bound, what is
/// unseen may begin and complete answers, or complete where one has begun. The second only matters
/// above the highest unseen value of p, which must be a constant: there no p is expected, and that
/// none has begun since it was asked says enough.
enum class Answer : std::uint8_t { at_once, in_two };
std::optional<Straight> response(StreamBuilder& streams, ir::Graph& graph, NodeId id,
                                 Answer answer);

/// F[A,B] (p && F[c,d] q) or its dual, [A,B] bounded: what has begun in [A,B] and is completed now,
/// q && O[c,d] p. Nothing for other formulas.
std::optional<Straight> fold_in_two(StreamBuilder& streams, ir::Graph& graph, NodeId id);

}  // namespace etlc::plan
