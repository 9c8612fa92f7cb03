// Made by etlc 0.2.0 from example.etl: change that, and run etlc again.
//
//   made from                XXH64
//   example.etl              b969834d30a9eb86
//   target sets and weights  541b091ac8a2d1e1
//   thresholds               5fd205765801e84c
//
//   monitor       about       state B  targets B  operations  distance elements
//   stays         the prefix       16         16           2                  4
//   all together                   20         16           2                  4
//
//   predicate  measures             threshold at first  origin
//   near_goal  min l2(z, goal) <=   0.409               written in the spec; no guarantee
//
// Retargetable: target sets, thresholds and the numbers of projections, metrics and expressions lie
// in parameters of 192 bytes. A monitor holds a pointer to them, besides state B, and may exchange
// them: above are those that the class was made with, and lower and upper hold for any.
//
// state B: of a monitor alone, what it shares with others counted in each. operations: min, max and
// comparisons of robustness keys in the worst step. distance elements: target elements that a step
// compares with its input.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "etlmon/params/params.hpp"
#include "etlmon/params/rows.hpp"
#include "etlmon/params/shadow.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "etlmon/version.hpp"

#if ETLMON_VERSION_MAJOR != 0 || ETLMON_VERSION_MINOR != 2
#error "made by etlc 0.2: run etlc again, or use the etlmon 0.2 that it was made for"
#endif

namespace example {
inline namespace ETLMON_BUILD {  // units compiled with other flags have another class

/// What the monitors see at one step. Inputs{} lacks everything.
struct Inputs {
  etlmon::Vector<float, 2> z;
};

/// What they answer: about the prefix so far or, sliding, about the position their horizon ago.
struct Verdicts {
  etlmon::Verdict stays;  // example.etl:10: monitor stays = G near_goal
};

/// The verdicts by name: for (const auto& [name, verdict] : named(verdicts)) ...
inline etlmon::Named<etlmon::Verdict, 1> named(const Verdicts& verdicts) noexcept {
  return {{
    {"stays", verdicts.stays}
  }};
}

/// Where thresholds lie, in floats from the first byte of the parameters.
namespace thresholds {
inline constexpr size_t near_goal = 16;
}  // namespace thresholds

/// Where target sets begin, a row after the other.
namespace targets {
inline constexpr size_t goal = 32;  ///< 2 rows of 2 elements
}  // namespace targets

/// What a block of parameters must be: of this shape, which is that of all below but its numbers,
/// and made with this encoder, 0 where the spec has none.
struct Layout {
  static constexpr uint64_t kShape = 0x5a0904caf8c7e272u;
  static constexpr uint64_t kEncoder = 0x0000000000000000u;
  static constexpr size_t kSize = 192;  ///< in bytes
  /// Where numbers lie, how many, how many a row, and what must hold for each.
  static constexpr etlmon::ParamsPart kParts[] = {
    {thresholds::near_goal, 1, 1, etlmon::ParamsPart::not_negative},
    {targets::goal, 4, 2, etlmon::ParamsPart::any}
  };
};
/// A block of parameters, in flash or in memory, at a multiple of 64 bytes: all of it is read once,
/// to be checked. It must stay as it is while a monitor has it.
using Params = etlmon::Params<Layout>;

/// Every monitor of the spec, stepped together. Any number of instances; none of them shares
/// anything.
class Monitor {
 public:
  using Value = etlmon::Value;      ///< a robustness; its ends differ where a sample is missing
  using Reading = etlmon::Reading;  ///< a value, and bounds that no continuation leaves

  /// What a step says about each predicate.
  struct Atoms {
    etlmon::Value near_goal;
  };

  /// What it costs.
  static constexpr size_t kStateBytes = etlmon::with_pointer(20);  ///< sizeof(Monitor)
  static constexpr uint32_t kOperations = 2;        ///< min, max, compare in the worst step
  static constexpr uint32_t kDistanceElements = 4;  ///< target elements measured in a step

  /// Without parameters: every predicate and bool input is unknown at every step, until retarget()
  /// gives some.
  constexpr Monitor() noexcept : numbers(nullptr) { reset(); }
  /// With these, where they are ready.
  constexpr explicit Monitor(const Params& params) noexcept : numbers(params.numbers()) { reset(); }
  /// Whether this monitor has parameters.
  bool ready() const noexcept { return numbers != nullptr; }
  /// What they were made from.
  etlmon::MadeFrom origin() const noexcept { return etlmon::made_from(numbers); }

  /// Between steps: other parameters from the next one on. Where they are not ready nothing
  /// changes, and the answer says why. Past::kept: verdicts go on, and steps that were measured
  /// count as what was measured then. Past::forgotten: reset().
  etlmon::ParamsState retarget(const Params& params, etlmon::Past past) noexcept {
    if (!params.ready()) {
      return params.state();
    }
    numbers = params.numbers();
    if (past == etlmon::Past::forgotten) {
      reset();
    }
    return params.state();
  }
  /// The same from the bytes of a block.
  etlmon::ParamsState retarget(const uint8_t* bytes, size_t size, etlmon::Past past) noexcept {
    return retarget(Params(bytes, size), past);
  }

  /// A new episode.
  constexpr void reset() noexcept {
    stays_ = etlmon::kTrue;
    near_goal_ = etlmon::kUnmeasured;
    incomplete = 0;
  }

  /// One call, one time step.
  Verdicts step(const Inputs& in) noexcept { return judge(measure(in)); }

  // A step in two halves: step(in) is judge(measure(in)). They share no member that either changes,
  // so one may interrupt the other; every measure() is followed by one judge() of what it gave, in
  // the same order.

  /// The robustness of every predicate at this step; counts the step if something was missing.
  Atoms measure(const Inputs& in) noexcept;
  /// One step of every formula, given this step's predicates.
  Verdicts judge(const Atoms& now) noexcept;

  /// Telemetry of the last step: a predicate's distance or expression, NaN where it was unknown,
  /// next to its threshold, and the row of the nearest target.
  float distance_near_goal() const noexcept { return near_goal_.delta; }
  float threshold_near_goal() const noexcept {
    return ready() ? numbers[thresholds::near_goal] : etlmon::kMissing;
  }
  uint32_t nearest_near_goal() const noexcept { return near_goal_.nearest; }

  /// Steps on which some predicate or bool input was unknown; saturates.
  uint32_t missing_steps() const noexcept { return incomplete; }

 private:
  /// What stands for what is not seen: anything, since other parameters may come.
  static Value unseen() noexcept {
    return Value{etlmon::kBottom, etlmon::kTop};
  }

  /// A step without parameters.
  Atoms unknown() noexcept {
    Atoms now;
    now.near_goal = unseen();
    if (incomplete != UINT32_MAX) {
      ++incomplete;
    }
    return now;
  }

  const float* numbers{};         // the parameters; null: none yet
  etlmon::Register stays_{};      // G near_goal
  etlmon::Measured near_goal_{};  // telemetry of near_goal
  uint32_t incomplete{};          // steps on which something was unknown; saturates
};
static_assert(sizeof(Monitor) == Monitor::kStateBytes, "no padding, no surprises");

inline Monitor::Atoms Monitor::measure(const Inputs& in) noexcept {
  if (!ready()) {
    return unknown();
  }
  Atoms now;
  bool missing = false;

  // example.etl:8: predicate near_goal = min l2(z, goal) <= 0.409
  near_goal_ = etlmon::measure_rows<etlmon::L2, etlmon::Min, 2, 2>(in.z, numbers + targets::goal);
  now.near_goal = etlmon::at_most(near_goal_.delta, threshold_near_goal(), unseen());
  missing = etlmon::is_nan(near_goal_.delta) || missing;

  if (missing && incomplete != UINT32_MAX) {
    ++incomplete;
  }
  return now;
}

inline Verdicts Monitor::judge(const Atoms& now) noexcept {
  using etlmon::max_of;
  using etlmon::min_of;

  // example.etl:10: G near_goal
  stays_ = min_of(stays_, now.near_goal);
  const Reading stays_reading = {stays_, etlmon::kBottom, stays_.high};

  Verdicts verdicts;
  verdicts.stays = etlmon::prefix_verdict(stays_reading);
  return verdicts;
}

/// Two of them side by side: one answers, the other has parameters that are on trial, and what
/// differs is counted (etlmon/params/shadow.hpp).
using Shadow = etlmon::Shadow<Monitor, Inputs, Verdicts, 1>;

}  // namespace ETLMON_BUILD
}  // namespace example
