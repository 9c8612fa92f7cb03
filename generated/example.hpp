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
//   predicate  measures             threshold  origin
//   near_goal  min l2(z, goal) <=   0.409      written in the spec; no guarantee
//
// state B: of a monitor alone, what it shares with others counted in each. operations: min, max and
// comparisons of robustness keys in the worst step. distance elements: target elements that a step
// compares with its input.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "etlmon/distance/kernel.hpp"
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

/// Target sets, a row after the other.
namespace targets {
/// literal: 2 rows of 2 elements
alignas(64) inline constexpr float goal[2 * 2] = {
  0.0f, 0.0f,
  1.0f, 0.0f
};
}  // namespace targets

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

  /// What the class was made from, as XXH64: log it with the verdicts.
  static constexpr uint64_t kSpecHash = 0xb969834d30a9eb86u;        ///< example.etl
  static constexpr uint64_t kDataHash = 0x541b091ac8a2d1e1u;        ///< target sets and weights
  static constexpr uint64_t kThresholdsHash = 0x5fd205765801e84cu;  ///< thresholds, as they begin
  /// What it costs.
  static constexpr size_t kStateBytes = 20;         ///< sizeof(Monitor)
  static constexpr uint32_t kOperations = 2;        ///< min, max, compare in the worst step
  static constexpr uint32_t kDistanceElements = 4;  ///< target elements measured in a step

  constexpr Monitor() noexcept { reset(); }

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
  static constexpr float threshold_near_goal() noexcept { return 0.409f; }
  uint32_t nearest_near_goal() const noexcept { return near_goal_.nearest; }

  /// Steps on which some predicate or bool input was unknown; saturates.
  uint32_t missing_steps() const noexcept { return incomplete; }

 private:
  /// All that the robustness of a predicate can be: what stands for it where it is not seen.
  static Value unseen_near_goal() noexcept {
    return Value{etlmon::kBottom, etlmon::key_of(0.409f)};
  }

  etlmon::Register stays_{};      // G near_goal
  etlmon::Measured near_goal_{};  // telemetry of near_goal
  uint32_t incomplete{};          // steps on which something was unknown; saturates
};
static_assert(sizeof(Monitor) == Monitor::kStateBytes, "no padding, no surprises");

inline Monitor::Atoms Monitor::measure(const Inputs& in) noexcept {
  Atoms now;
  bool missing = false;

  // example.etl:8: predicate near_goal = min l2(z, goal) <= 0.409
  near_goal_ = etlmon::measure<etlmon::L2, etlmon::Min, 2, 2, targets::goal>(in.z);
  now.near_goal = etlmon::at_most(near_goal_.delta, threshold_near_goal(), unseen_near_goal());
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

}  // namespace ETLMON_BUILD
}  // namespace example
