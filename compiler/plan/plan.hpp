// What a monitor does at every step, in order: the last form before code.
// Takes: the graph. Gives: emit/ and the evaluator the same steps to print and to execute.
// Keeps true: streams and readings stand in an order in which operands come first; each distance,
// stream and reading is computed once however many monitors use it; the state is fixed here and
// does not depend on the trace.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "etlmon/temporal/value.hpp"
#include "ir/lower.hpp"
#include "plan/program/machine.hpp"

namespace etlc::plan {

using check::Index;
using check::kUnbounded;
using etlmon::Key;
using etlmon::Value;
using ir::NodeId;

// ---- streams: a robustness for one position after the other -------------------------------------

enum class StreamOp : std::uint8_t {
    constant,     ///< `value`
    predicate,    ///< of the model's predicates
    flag,         ///< a bool input, by its index in the model
    negation,     ///< of a predicate or flag
    combination,  ///< max of the operands
    within,       ///< the operand at the positions of `interval`, elsewhere `value`
    delay,     ///< the operand `length` steps ago: later by `length`, so that operands of different
               ///< lag meet
    shift,     ///< the operand `length` positions earlier; `value` where there is none
    running,   ///< max over all positions so far
    window,    ///< max over the last `length` positions
    widening,  ///< the same, from the operand, which is that over fewer
    since,     ///< v = max(g, min(v, f))
    window_since,  ///< since, over the last `length` positions
    window_until,  ///< until, at the first of the last `length` positions
};

/// The max of nothing; of a dual, whose max is a min, the min of nothing.
constexpr Value neutral(bool max) {
    return max ? etlmon::kFalse : etlmon::kTrue;
}

struct Stream {
    StreamOp op = StreamOp::constant;
    bool max = true;  ///< else the dual: where the operation says max it takes the min, and so on
    std::vector<Slot> operands;
    Index index = 0;                ///< predicate or flag
    std::uint32_t length = 0;       ///< of delays, shifts, windows and widenings
    std::uint32_t from_length = 0;  ///< widening: of the operand's window
    ir::Interval interval;          ///< within: of positions
    /// constant; shift: where there is no earlier position; within: elsewhere; since, trigger:
    /// before the first position
    Value value{};
    std::uint32_t lag = 0;  ///< after step i the stream tells about position i - lag
    /// And its operands about position i - operand_lag; a constant is of any lag.
    std::uint32_t operand_lag = 0;
    NodeId node = kNone;  ///< the formula it is, for comments; kNone for the values in between
};

// ---- readings: what prefix monitors say about position 0 ----------------------------------------

/// A formula without future at the top: its value at step 0, for good.
struct Latch {
    Slot operand = 0;
};

/// F or U, or the duals G and R, over operands without future: a max or min that grows while the
/// window is open.
struct Fold {
    bool max = true;
    ir::Interval interval;
    Slot left = kNone;  ///< of U and R
    Slot right = 0;
    Slot unseen = 0;  ///< lowest and highest unseen value of `right`
};

/// G[A,B] (f || F[a,b] g) and its dual F[A,B] (f && G[a,b] g), f and g without future. What the
/// positions whose window is still open say is one recurrence, pending = max(min(pending, f), g),
/// true before the first position. And they are settled by the same value: the window of some
/// position passed without an answer exactly where pending stayed low for b - a + 1 steps on end,
/// so settled = min(settled, the max of the last b - a + 1 pendings). (Both sides are made of min
/// and max, so it is enough to compare them where f and g are only true or false: a run of false
/// pendings begins with a position that asks and lasts until an answer.) Without f and from every
/// position, pending is g itself and the body's own stream settles.
struct Response {
    bool of_always = true;  ///< else the dual
    ir::Interval outer;
    ir::Interval inner;    ///< bounded
    Slot passed = 0;       ///< what the windows that close at this step came to
    Slot pending = kNone;  ///< what open windows say; kNone: none has begun at the last positions,
                           ///< which is hopeless
    Slot recent = kNone;   ///< what speaks for positions whose windows have not begun; kNone:
                           ///< nothing, or none such
    Slot unseen_answer = 0;  ///< lowest and highest unseen value of g
    Slot unseen_body = 0;
};

/// F, G, U or R, or a state machine, over formulas with a bounded future. These are settled
/// `horizon` steps late; at the positions since, they are evaluated again at every step on the
/// prefix as it ends now (etlmon/temporal/pending.hpp), and the registers, which stand where
/// everything is settled, are carried over them.
struct Pending {
    struct Part {
        NodeId node = kNone;
        Slot leaf = kNone;  ///< a formula without future, else:
        bool max = true;    ///< ||, F or U; else the dual
        ir::Interval interval;
        std::vector<std::uint32_t> operands;  ///< parts
        Slot unseen = kNone;                  ///< of temporal operators: of the last operand
    };
    std::vector<Part> parts;  ///< operands first
    std::uint32_t horizon = 0;
    bool is_fold = true;
    Fold fold;        ///< is_fold: left and right are parts
    Machine machine;  ///< else, as a table; its guards are in `guards`
    std::vector<std::vector<std::uint32_t>> guards;  ///< per guard of the automaton, parts
};

struct Reading {
    enum class Kind : std::uint8_t { latch, fold, response, machine, pending, combination };
    Kind kind = Kind::latch;
    NodeId node = 0;
    bool max = true;  ///< of a combination: the max of the operands, else the min
    Latch latch;
    Fold fold;
    Response response;
    Machine machine;  ///< for other nestings: a weighted automaton over (max, min)
    Pending pending;
    std::vector<std::uint32_t> operands;  ///< readings, of a combination
};

/// Every place in a reading that names a stream; some may be kNone.
std::vector<Slot*> slots_of(Reading& reading);

// ---- the plan -----------------------------------------------------------------------------------

struct Monitor {
    std::string name;
    bool sliding = false;
    std::uint32_t horizon = 0;
    std::uint32_t reading = kNone;  ///< prefix monitors
    Slot stream = kNone;            ///< sliding monitors: the verdicts, lagging by the horizon
    Index index = 0;                ///< of the model's monitors
    NodeId node = 0;                ///< its formula
    bool shifted = false;           ///< calibrated as a whole: all its numbers are less by `shift`
    float shift = 0;
};

/// Worst case of one step and fixed sizes, of the whole or of one monitor (what it shares is
/// counted in each).
struct Cost {
    std::uint64_t state_bytes = 0;
    std::uint64_t stack_bytes = 0;   ///< arrays of a step: positions that are evaluated again
    std::uint64_t target_bytes = 0;  ///< and weights, on a machine with vectors of floats
    std::uint64_t scalar_target_bytes = 0;  ///< the same on one without
    std::uint64_t code_bytes = 0;           ///< estimated, targets aside
    std::uint64_t operations = 0;           ///< min, max and comparisons of the temporal part
    std::uint64_t distance_operations = 0;  ///< element differences accumulated: K x D a distance
};

/// A target set that lies in the file beside the header, see stored.hpp.
struct StoredSet {
    Index target = 0;
    bool as_given = true;  ///< else rows of length 1
    std::uint64_t offset = 0;
    std::uint64_t row_bytes = 0;  ///< from a row to the next
};

/// How the elements of target sets are kept.
enum class Storage : std::uint8_t { f32, f16, i8 };

/// A comparison turns at a number, or somewhere in [low, high].
struct Cut {
    float low = 0;
    float high = 0;
};

/// The narrow copy of a target set on which a distance is measured, see narrow_targets.hpp.
struct NarrowSet {
    Index distance = 0;
    Storage storage = Storage::f16;
    std::uint32_t rows = 0;
    std::uint32_t dimension = 0;
    std::vector<std::uint16_t> halves;  ///< f16: IEEE bits
    std::vector<std::int8_t> bytes;     ///< i8
    float scale = 1;                    ///< i8: value = scale x integer
    float moved = 0;        ///< no row is farther from its float32 row, in the distance's norm
    bool lossless = false;  ///< every element widens to the float32 it was: no other copy is kept
    std::vector<Cut> cuts;  ///< of the distance: where some predicate's comparison turns
};

struct Plan {
    const check::Model* model = nullptr;
    /// The program's graph, and what readings owe from one step to the next: what `node` means.
    std::shared_ptr<const ir::Graph> formulas;
    check::Values values = check::Values::robustness;
    std::vector<Index> inputs;  ///< that some monitor depends on, in order of declaration
    std::vector<Index> targets;
    std::vector<Index> distances;
    std::vector<StoredSet> stored;
    std::vector<NarrowSet> narrow;  ///< of some distances
    std::vector<Index> predicates;
    std::vector<Stream> streams;
    std::vector<Reading> readings;
    std::vector<Monitor> monitors;
    bool has_sliding = false;
    bool counts_steps = false;  ///< some part needs the number of the step
    Cost cost;
    std::vector<Cost> monitor_costs;
};

struct Limits {
    std::uint64_t state_bytes = 1U << 20U;  ///< and the stack of a step with it
    std::uint64_t code_bytes = 64U << 10U;
    std::uint64_t operations = 1U << 20U;
    /// Larger target sets go to a file beside the header.
    std::uint64_t inline_target_bytes = 256U << 10U;
};

/// Plans every monitor, or reports the ones whose exact state, code or work exceeds the limits.
std::optional<Plan> plan(const ir::Program& program, const Limits& limits, diag::Sink& sink,
                         check::Values values = check::Values::robustness,
                         Storage targets_as = Storage::f32);

/// A plan without monitors: the evaluator then only measures these predicates, as it does for
/// monitors that use them.
Plan measuring(const check::Model& model, const std::vector<Index>& predicates);

/// The plan as text: `--emit plan`.
std::string print(const Plan& plan);

}  // namespace etlc::plan
