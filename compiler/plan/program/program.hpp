// The plan: the operations of every step in order, the last form before code. The emitter prints
// them and the evaluator executes them. Operands come before their users; each distance, stream and
// reading is computed once however many monitors use it; the size of the state does not depend on
// the trace.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "check/model/model.hpp"
#include "ir/lower.hpp"
#include "plan/program/reading.hpp"

namespace etlc::plan {

struct Monitor {
    std::string name;
    bool sliding = false;
    check::Restarts restarts = check::Restarts::never;
    bool counts_steps = false;  ///< for monitors that restart: some part counts steps from there
    std::uint32_t horizon = 0;
    std::uint32_t ahead = kUnbounded;  ///< of a repeating monitor: as in the model
    std::uint32_t reading = kNone;     ///< prefix monitors
    Slot stream = kNone;               ///< sliding monitors: the verdicts, lagging by the horizon
    Index index = 0;                   ///< of the model's monitors
    NodeId node = 0;                   ///< node of its formula
    bool shifted = false;  ///< calibrated as a whole: `shift` is subtracted from all its numbers
    float shift = 0;
    std::optional<float> inner_shift{};  ///< of two shifts: that of the low end and of `lower`

    /// Returns what it begins with, as a reading says it; `own`: its index.
    std::uint32_t begins_with(std::uint32_t own) const {
        return restarts == check::Restarts::never ? kNone : own;
    }
};

/// A let whose verdict is telemetry.
struct Let {
    Index index = 0;  ///< of the model's lets
    Slot stream = kNone;
};

/// Costs of the worst step and fixed sizes, of the whole plan or of one monitor (shared parts count
/// in each).
struct Cost {
    std::uint64_t state_bytes = 0;
    std::uint64_t stack_bytes = 0;          ///< arrays of a step: what_takes_stack()
    std::uint64_t target_bytes = 0;         ///< with weights, on a machine with float vectors
    std::uint64_t scalar_target_bytes = 0;  ///< the same on a machine without
    std::uint64_t code_bytes = 0;           ///< estimated, targets aside
    std::uint64_t operations = 0;           ///< min, max and comparisons of the temporal part
    std::uint64_t distance_operations = 0;  ///< accumulated element differences: K x D per distance
};

/// A target set in the file beside the header (stored.hpp), or the matrix of a projection as one
/// row.
struct StoredSet {
    Index target = 0;
    bool as_given = true;  ///< else rows of length 1
    std::uint64_t offset = 0;
    std::uint64_t row_bytes = 0;      ///< from a row to the next
    Index projection = check::kNone;  ///< else a target
};

/// The element type of target sets.
enum class Storage : std::uint8_t { f32, f16, i8 };

/// A comparison changes at a number, or somewhere in [low, high].
struct Cut {
    float low = 0;
    float high = 0;
};

/// The narrow copy of a target set that a distance is measured on (narrow_targets.hpp).
struct NarrowSet {
    Index distance = 0;
    Storage storage = Storage::f16;
    std::uint32_t rows = 0;
    std::uint32_t dimension = 0;
    std::vector<std::uint16_t> halves;  ///< f16: IEEE bits
    std::vector<std::int8_t> bytes;     ///< i8
    float scale = 1;                    ///< i8: value = scale x integer
    float moved = 0;                    ///< bound of the distance of a row from its float32 row
    bool lossless = false;  ///< every element widens to its float32: no other copy is kept
    std::vector<Cut> cuts;  ///< of the distance, for all predicates
};

/// The flight recorder of the class, in steps (recorder_plan.hpp).
struct Recorder {
    std::uint32_t before = 0;
    std::uint32_t after = 0;
    std::uint32_t incidents = 0;
};

struct Plan {
    const check::Model* model = nullptr;
    /// The program's graph, and obligations of readings: the formulas that `node` refers to.
    std::shared_ptr<const ir::Graph> formulas;
    check::Values values = check::Values::robustness;
    std::vector<Index> inputs;  ///< inputs of all monitors, in order of declaration
    std::vector<Index> targets;
    std::vector<Index> distances;
    std::vector<Index> pasts;  ///< of the model, each after those that it contains
    std::vector<StoredSet> stored;
    std::vector<NarrowSet> narrow;  ///< of some distances
    std::vector<Index> predicates;
    std::vector<Stream> streams;
    std::vector<Reading> readings;
    std::vector<Monitor> monitors;
    std::vector<Let> lets;
    std::vector<Index> drifts;  ///< of the model, those with scores of calibration
    bool has_sliding = false;
    bool counts_steps = false;  ///< some part uses the number of the step
    std::optional<Recorder> recorder;
    Cost cost;
    std::vector<Cost> monitor_costs;
};

/// Prints the plan: `--emit plan`.
std::string print(const Plan& plan);

}  // namespace etlc::plan
