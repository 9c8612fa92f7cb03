// SPDX-License-Identifier: MIT
// Why: the samples whose values verdicts have.
// Takes: what verdicts are made from, in values that know their sample. Gives: the verdicts, and
// the sample that decides each. Keeps true: one number a monitor, whatever the formula: its rank
// says the predicate, the step and the row, and its key the robustness, from which the distance
// follows.
#pragma once

#include <stdint.h>

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/sourced.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Of a sample that names no nearest target.
constexpr uint32_t kNoRow = 0xffffffffu;

/// A predicate or a bool at a step: why a verdict is what it is.
struct Sample {
  const char* predicate = nullptr;  ///< its name, or its comparison; nullptr: there is no sample
  uint32_t step = 0;                ///< of the episode; UINT32_MAX: too late to be counted
  float robustness = kMissing;      ///< of the predicate at that step; NaN: a sample was missing
  float distance = kMissing;        ///< or expression, to the last place; of a bool 1 or 0
  float threshold = kMissing;       ///< NaN: it adapts, or is that of a bool
  uint32_t row = kNoRow;            ///< of the target that was nearest; kNoRow: none is named

  constexpr explicit operator bool() const noexcept { return predicate != nullptr; }
};

/// A predicate or bool of the spec: the codes of its samples.
struct Place {
  enum class Kind : uint8_t { at_most, at_least, truth };
  const char* name;
  Kind kind;        ///< truth: of a bool, == and !=
  float threshold;  ///< of one that adapts NaN
  uint32_t first;   ///< its code, that of row 0 where it names rows
  uint32_t rows;    ///< as many codes; then one of a sample that is missing

  /// The distance at which the predicate has this robustness; NaN: that does not say it.
  float distance_at(Key robustness) const noexcept {
    if (kind == Kind::truth) return !is_nan(threshold) ? kMissing : robustness > 0 ? 1.0f : 0.0f;
    if (is_nan(threshold) || robustness == kTop || robustness == kBottom) return kMissing;
    const float rho = float_of(robustness);
    return detail::rounded(kind == Kind::at_most ? threshold - rho : threshold + rho);
  }
};

// What is taken from the rank of a step's first sample.
/// Of a number; of the row that was nearest, where `rows` are told apart, else it is 0 of 1.
ETLMON_INLINE uint32_t code_of(uint32_t first, const float& measured, uint32_t row = 0,
                               uint32_t rows = 1) noexcept {
  return 2 * (first + (is_nan(measured) ? rows : row));
}
/// Of a bool.
ETLMON_INLINE uint32_t code_of(uint32_t first, const Flag& flag) noexcept {
  return 2 * (first + (flag.present() ? 0 : 1));
}

/// Of the last verdict of each monitor, the value that decides it.
template <uint32_t Monitors>
class Deciding {
 public:
  constexpr void reset() noexcept {
    for (SourcedKey& key : keys_) key = SourcedKey(0);
  }

  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of) noexcept {
    return prefix(m, of, unsourced(of));
  }
  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of,
                             const float& shift) noexcept {
    return prefix(m, of, shifted(unsourced(of), shift));
  }

  ETLMON_STEP Verdict sliding(uint32_t m, Sourced of) noexcept {
    return sliding(m, of, unsourced(of));
  }
  ETLMON_STEP Verdict sliding(uint32_t m, Sourced of, const float& shift) noexcept {
    return sliding(m, of, shifted(unsourced(of), shift));
  }
  ETLMON_STEP Verdict undecided(uint32_t m) noexcept {
    keys_[m] = SourcedKey(0);
    return {};
  }

  SourcedKey operator[](uint32_t m) const noexcept { return keys_[m]; }

 private:
  /// Of one that is for good the bound that makes it so; of one that is unknown nothing.
  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of, Reading said) noexcept {
    const int64_t holds = said.lower >= 0 ? of.lower.order : of.rho.low.order;
    const int64_t fails = said.upper < 0 ? of.upper.order : of.rho.high.order;
    decide(m, said.rho, holds, fails);
    return prefix_verdict(said.rho, said.lower, said.upper);
  }
  ETLMON_STEP Verdict sliding(uint32_t m, Sourced of, Value said) noexcept {
    decide(m, said, of.low.order, of.high.order);
    return sliding_verdict(said);
  }
  ETLMON_STEP void decide(uint32_t m, Value rho, int64_t holds, int64_t fails) noexcept {
    keys_[m].order = rho.low >= 0 ? holds : rho.high < 0 ? fails : SourcedKey(0).order;
  }

  SourcedKey keys_[Monitors];
};

/// What a value is of: of predicates and bools in the order of the spec, with `Codes` in all.
template <uint32_t Codes, uint32_t Places>
Sample sample_of(SourcedKey value, const Place (&places)[Places]) noexcept {
  using Order = Ranks<Codes>;
  Sample result;
  const Rank rank = value.rank();
  if (!Order::is_sample(rank)) return result;
  const uint32_t code = Order::code(rank), step = Order::step(rank);
  uint32_t at = Places - 1;
  while (places[at].first > code) --at;
  const Place& place = places[at];
  result.predicate = place.name;
  result.step = step < Order::kLastStep ? step : UINT32_MAX;
  result.threshold = place.threshold;
  const uint32_t row = code - place.first;
  const bool names_rows = place.rows > 0;
  if (row == (names_rows ? place.rows : 1)) return result;  // it was missing
  const Key key = Order::is_negated(rank) ? -value.key() : value.key();
  result.robustness = float_of(key);
  result.distance = place.distance_at(key);
  if (names_rows) result.row = row;
  return result;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
