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
#include "etlmon/temporal/machine.hpp"
#include "plan/program/program.hpp"
#include "plan/program/reading.hpp"
#include "plan/targets/kernels.hpp"

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

// The streams that a Boolean monitor evaluates only on demand of a verdict. Only streams without
// memory can wait; robustness is always computed, since every part of it can matter.

struct Plan;

/// Returns whether a stream of a Boolean monitor is evaluated on demand: an atom, or made of such;
/// `known` has the answer for the streams before it.
bool found_on_demand(const Stream& stream, const std::vector<bool>& known);

struct Demand {
    bool lazy = false;       ///< evaluated on demand
    std::uint64_t work = 0;  ///< target elements that it may measure
    std::uint64_t asks = 1;  ///< queries of atoms and kept values, at most
    /// Whether its result is kept because several streams use it: otherwise queries double with
    /// each level.
    bool keeps = false;
};
std::vector<Demand> demands(const Plan& plan);

// What the parts of a plan are estimated to cost.

inline constexpr std::uint64_t kWord = sizeof(std::uint32_t);
inline constexpr std::uint64_t kKeysPerValue = 2;
/// For a window whose highs and lows differ: finding the blocks with highs of their own
/// (etlmon::Parting).
inline constexpr std::uint64_t kPartingComparisons = 6;
/// The lists of greatest values that a step of a count combines, and their results.
inline constexpr std::uint64_t kListsOnStack = 6;

// Estimated code, measured on x86-64 and Cortex-M4 at -O2 and -Os and rounded up.
inline constexpr std::uint64_t kCodePerValueOperation = 24;
inline constexpr std::uint64_t kCodePerEnd = 16;
inline constexpr std::uint64_t kCodePerReading = 64;
inline constexpr std::uint64_t kCodePerWindow = 240;
inline constexpr std::uint64_t kCodePerRing = 64;
inline constexpr std::uint64_t kCodePerMean = 1200;       // of which all means share the most
inline constexpr std::uint64_t kCodePerAdaptation = 144;  // observe_P() on a Cortex-M4 at -Os
inline constexpr std::uint64_t kCodePerDrift = 900;       // with divisions in software
inline constexpr std::uint64_t kCodePerTable = 200;
inline constexpr std::uint64_t kCodePerSamples = 600;
inline constexpr std::uint64_t kTransitionBytes = sizeof(etlmon::Transition);
inline constexpr std::uint64_t kStateBytes = sizeof(std::uint32_t) + sizeof(etlmon::Obligations);

}  // namespace etlc::plan
