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
std::optional<Straight> response(StreamBuilder& streams, ir::Graph& graph, NodeId id);

}  // namespace etlc::plan
