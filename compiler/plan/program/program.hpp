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
#include "ir/lower.hpp"
#include "plan/program/reading.hpp"
#include "plan/program/stream.hpp"

namespace etlc::plan {

struct Monitor {
    std::string name;
    bool sliding = false;
    check::Restarts restarts = check::Restarts::never;
    bool counts_steps = false;  ///< where it restarts: some part of it counts from there
    std::uint32_t horizon = 0;
    std::uint32_t reading = kNone;  ///< prefix monitors
    Slot stream = kNone;            ///< sliding monitors: the verdicts, lagging by the horizon
    Index index = 0;                ///< of the model's monitors
    NodeId node = 0;                ///< its formula
    bool shifted = false;           ///< calibrated as a whole: all its numbers are less by `shift`
    float shift = 0;
};

/// A let whose verdict at the present step is telemetry.
struct Let {
    Index index = 0;  ///< of the model's lets
    Slot stream = kNone;
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

/// A target set that lies in the file beside the header, see stored.hpp; or the matrix of a
/// projection, as one row.
struct StoredSet {
    Index target = 0;
    bool as_given = true;  ///< else rows of length 1
    std::uint64_t offset = 0;
    std::uint64_t row_bytes = 0;      ///< from a row to the next
    Index projection = check::kNone;  ///< else a target
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

/// The flight recorder of the class, in steps; see recorder.hpp.
struct Recorder {
    std::uint32_t before = 0;
    std::uint32_t after = 0;
    std::uint32_t incidents = 0;
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
    std::vector<Let> lets;
    bool has_sliding = false;
    bool counts_steps = false;  ///< some part needs the number of the step
    std::optional<Recorder> recorder;
    Cost cost;
    std::vector<Cost> monitor_costs;
};

/// The plan as text: `--emit plan`.
std::string print(const Plan& plan);

}  // namespace etlc::plan
