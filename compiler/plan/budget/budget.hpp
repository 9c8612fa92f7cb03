// The costs of a plan, which `--emit report` and the table of the generated header show.
// state_bytes is exactly the size of the generated class; stack_bytes the arrays of its step;
// operations count every min, max and comparison of two keys in the worst step (a Value has two
// keys); code_bytes is an estimate.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "check/model/model.hpp"
#include "diag/diag.hpp"
#include "plan/program/program.hpp"
#include "plan/targets/point_checks.hpp"

namespace etlc::plan {

struct Limits {
    std::uint64_t state_bytes = 1U << 20U;  ///< including the stack of a step
    std::uint64_t code_bytes = 64U << 10U;
    std::uint64_t operations = 1U << 20U;
    /// Larger target sets go to a file beside the header.
    std::uint64_t inline_target_bytes = 256U << 10U;
};

/// Returns what would fit in place of a monitor, with all others or alone.
enum class Among : std::uint8_t { all, alone };
using Advice = std::function<std::vector<diag::Note>(check::Index monitor, Among among)>;

Cost operator+(Cost a, const Cost& b);
bool within(const Cost& cost, const Limits& limits);
/// Returns the parts of a plan whose arrays are on the stack: "projected points, counts".
std::string what_takes_stack(const Plan& plan);
/// Describes a cost: "12 bytes of state, 216 bytes of code (estimated), 3 operations a step".
std::string in_words(const Cost& cost);
Cost cost_of(const Stream& stream, check::Values values);
Cost cost_of(const Reading& reading, check::Values values);
Cost cost_of(const check::Past& past);
/// Returns the cost of the samples that are kept for a point.
Cost cost_of(const check::Model& model, const EarlierPoint& earlier);
/// Returns the target elements that a predicate measures.
std::uint64_t measured_elements(const check::Model& model, Index predicate);
/// Returns the same, with those of its projections.
std::uint64_t elements_of(const check::Model& model, Index predicate);
/// Returns the cost of a state machine of this size as a table.
Cost cost_of_table(std::size_t states, std::size_t transitions, check::Values values);
/// Fills in plan.cost and plan.monitor_costs.
void add_costs(Plan& plan);

/// Whether a machine has float vectors: x86-64 and 64-bit Arm do, microcontrollers do not.
enum class Vectors : bool { without, with };

/// Returns the bytes of the target sets and weights of these distances, exactly as the runtime lays
/// them out (etlmon/layout.hpp); sets in the file of targets count as stored there.
std::uint64_t target_bytes(const Plan& plan, const std::set<Index>& distances, Vectors vectors);

}  // namespace etlc::plan
