// SPDX-License-Identifier: MIT
// Why: the samples whose values verdicts have, and what was measured there.
// Takes: what was seen at a step, the values that may outlive it, and the verdicts. Gives: the
// sample that decides each verdict. Keeps true: fixed memory; a step costs a row, a comparison a
// value and a few words a verdict. A sample is remembered while it is among the last Steps, and
// from then on while one of the followed values is its own; of another one the step is known, and
// what was measured there is not.
#pragma once

#include <stdint.h>

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/sourced.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Of a sample whose predicate has no nearest target.
constexpr uint32_t kNoRow = 0xffffffffu;

/// A predicate or a bool at a step: why a verdict is what it is.
struct Sample {
  const char* predicate = nullptr;  ///< its name, or its comparison; nullptr: there is no sample
  uint32_t step = 0;                ///< of the episode; UINT32_MAX: too late to be counted
  float distance = kMissing;        ///< or expression; of a bool 1 or 0; NaN: missing, or forgotten
  float threshold = kMissing;       ///< at that step; of a bool NaN
  uint32_t row = kNoRow;            ///< of the target that was nearest; kNoRow: it has none

  constexpr explicit operator bool() const noexcept { return predicate != nullptr; }
};

/// What was seen of a predicate or bool at a step, in a class none of whose predicates has a
/// nearest target.
struct SeenNumber {
  float measured = kMissing;
};
/// In a class where some have one.
struct Seen {
  float measured = kMissing;
  uint32_t nearest = kNoRow;
};
/// In a class some of whose thresholds adapt.
struct SeenAdapting {
  float measured = kMissing;
  uint32_t nearest = kNoRow;
  float threshold = kMissing;
};

/// The measured value of a bool.
ETLMON_INLINE float measured(const Flag& flag) noexcept {
  return !flag.present() ? kMissing : flag.value() ? 1.0f : 0.0f;
}

/// What a sample is called, and its threshold; of one that adapts NaN.
struct Place {
  const char* name;
  float threshold;
};

/// S: what is seen of a sample, one of the three above; of `Places` predicates and bools in the
/// order of the spec.
template <class S, uint32_t Places, uint32_t Steps, uint32_t Followed, uint32_t Monitors>
class Samples {
  static_assert(Places > 0 && Steps > 0 && Monitors > 0, "there is something to explain");
  using Order = Ranks<Places>;

 public:
  void reset() noexcept {
    last_ = UINT32_MAX;
    newest_ = 0;
    for (Two& value : followed_) value = Two();
    for (Answer& answer : answers_) answer = Answer();
  }

  /// What was seen at a step: before anything is asked of it.
  ETLMON_STEP void step(uint32_t step, const S (&seen)[Places]) noexcept {
    last_ = step;
    if (Steps > 1) newest_ = newest_ + 1 == Steps ? 0 : newest_ + 1;
    for (uint32_t i = 0; i < Places; ++i) rows_[newest_][i] = seen[i];
  }

  /// Keeps the samples of a value that may outlive the steps, at the last step that has them.
  /// `rank`: the distance of this step's first sample. Of several values, in the order in which
  /// they were computed, so that one that took another's sample finds it there.
  ETLMON_STEP void follow(uint32_t i, Sourced value, uint32_t rank) noexcept {
    const uint32_t oldest = rank + (Steps - 1) * Places - (Places - 1);
    const Rank low = value.low.rank(), high = value.high.rank();
    if (Order::distance(low) < oldest && Order::distance(high) < oldest) return;
    if (low != followed_[i].low || high != followed_[i].high) take(i, low, high);
  }

  /// What a verdict may be decided by.
  ETLMON_STEP void answer(uint32_t m, const BasicReading<Sourced>& reading,
                          const Verdict& verdict) noexcept {
    answers_[m] = {reading.rho.low.rank(), reading.rho.high.rank(), reading.lower.rank(),
                   reading.upper.rank(), verdict.status};
  }

  /// Of a sliding one: what it is the robustness of.
  ETLMON_STEP void answer(uint32_t m, Sourced value, const Verdict& verdict) noexcept {
    answers_[m].lower = value.low.rank();
    answers_[m].upper = value.high.rank();
    answers_[m].status = verdict.status;
  }

  /// What decides it.
  Sample sample(uint32_t m, const Place (&places)[Places]) const noexcept {
    Sample result;
    const Rank rank = answers_[m].deciding();
    if (!Order::is_sample(rank)) return result;
    const Place& place = places[Order::place(rank)];
    const uint32_t step = Order::step(rank);
    const S seen = find(rank);
    result.predicate = place.name;
    result.step = step < Order::kLastStep ? step : UINT32_MAX;
    result.distance = seen.measured;
    result.threshold = threshold(seen, place);
    if (!is_nan(result.distance)) result.row = nearest(seen);
    return result;
  }

 private:
  struct Two {
    Rank low = kUnseen, high = kUnseen;
    S low_seen, high_seen;
  };
  /// Of a verdict: the ends of what it is made from.
  struct Answer {
    Rank low = kUnseen, high = kUnseen, lower = kUnseen, upper = kUnseen;
    uint32_t status = 0;

    /// Of one that is for good the bound that makes it so; of one that is unknown nothing.
    Rank deciding() const noexcept {
      const bool is_final = (status & Verdict::kFinal) != 0;
      if ((status & Verdict::kSatisfied) != 0) return is_final ? lower : low;
      if ((status & Verdict::kViolated) != 0) return is_final ? upper : high;
      return kUnseen;
    }
  };

  static uint32_t nearest(const SeenNumber&) noexcept { return kNoRow; }
  template <class WithRow>
  static uint32_t nearest(const WithRow& seen) noexcept {
    return seen.nearest;
  }
  template <class WithoutThreshold>
  static float threshold(const WithoutThreshold&, const Place& place) noexcept {
    return place.threshold;
  }
  static float threshold(const SeenAdapting& seen, const Place& place) noexcept {
    return is_nan(place.threshold) ? seen.threshold : place.threshold;
  }

  ETLMON_COLD void take(uint32_t i, Rank low, Rank high) noexcept {
    const S low_seen = find(low);
    const S high_seen = low == high ? low_seen : find(high);
    followed_[i] = {low, high, low_seen, high_seen};
  }

  S find(Rank rank) const noexcept {
    if (!Order::is_sample(rank)) return {};
    const uint32_t step = Order::step(rank);
    if (step >= Order::kLastStep) return {};
    const uint32_t age = last_ - step;
    if (age < Steps)
      return rows_[newest_ >= age ? newest_ - age : newest_ + Steps - age][Order::place(rank)];
    const uint32_t distance = Order::distance(rank);
    for (const Two& value : followed_) {
      if (Order::distance(value.low) == distance) return value.low_seen;
      if (Order::distance(value.high) == distance) return value.high_seen;
    }
    return {};
  }

  uint32_t last_;    ///< step
  uint32_t newest_;  ///< its row
  Two followed_[Followed];
  Answer answers_[Monitors];
  S rows_[Steps][Places];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
