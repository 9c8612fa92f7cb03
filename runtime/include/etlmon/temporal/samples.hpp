// SPDX-License-Identifier: MIT
// Explanations: the samples that decide verdicts. Takes: values that carry their sample. Gives:
// verdicts, and the sample that decides each. Keeps true: one number per monitor for any formula.
// Its rank encodes predicate, step and row; its key is the robustness, from which the distance
// follows.
#pragma once

#include <stdint.h>

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/sourced.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The row of a sample without a nearest target.
constexpr uint32_t kNoRow = 0xffffffffu;

/// A predicate or bool at a step, which decides a verdict.
struct Sample {
  const char* predicate = nullptr;  ///< name, or comparison; nullptr: no sample
  uint32_t step = 0;                ///< in the episode; UINT32_MAX: beyond the counter
  float robustness = kMissing;      ///< of the predicate at that step; NaN: a sample was missing
  float distance = kMissing;        ///< or expression, within one ulp; 1 or 0 of a bool
  float threshold = kMissing;       ///< NaN if adaptive, or of a bool
  uint32_t row = kNoRow;            ///< of the nearest target, or kNoRow

  constexpr explicit operator bool() const noexcept { return predicate != nullptr; }
};

/// A predicate or bool of the spec, with the codes of its samples.
struct Place {
  enum class Kind : uint8_t { at_most, at_least, truth };
  const char* name;
  Kind kind;               ///< truth: a bool, == or !=
  float threshold;         ///< NaN if adaptive
  uint32_t first;          ///< first code: of row 0 if codes distinguish rows
  uint32_t rows;           ///< number of these codes; the next one is of a missing sample
  float inner = kMissing;  ///< of two thresholds the one within which it is true, else NaN

  /// Returns the distance at which the predicate has this robustness, measured from a threshold,
  /// NaN if that is unknown.
  float distance_at(Key robustness, const float& from) const noexcept {
    if (kind == Kind::truth) return !is_nan(from) ? kMissing : robustness > 0 ? 1.0f : 0.0f;
    if (is_nan(from) || robustness == kTop || robustness == kBottom) return kMissing;
    const float rho = float_of(robustness);
    return detail::rounded(kind == Kind::at_most ? from - rho : from + rho);
  }
};

// Offsets from the rank of the first sample of a step.
/// Returns the offset of a number, and of its nearest row if `rows` are distinguished (otherwise
/// row 0 of 1).
ETLMON_INLINE uint32_t code_of(uint32_t first, const float& measured, uint32_t row = 0,
                               uint32_t rows = 1) noexcept {
  return 2 * (first + (is_nan(measured) ? rows : row));
}
/// Returns the offset of a bool.
ETLMON_INLINE uint32_t code_of(uint32_t first, const Flag& flag) noexcept {
  return 2 * (first + (flag.present() ? 0 : 1));
}

/// The values that decide the last verdict of each monitor.
template <uint32_t Monitors>
class Deciding {
 public:
  constexpr void reset() noexcept {
    for (SourcedKey& key : keys_) key = SourcedKey(0);
  }

  // complete: the prefix has all that the formula looks ahead.
  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of,
                             bool complete = false) noexcept {
    return prefix(m, of, unsourced(of), complete);
  }
  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of, const float& shift,
                             bool complete = false) noexcept {
    return prefix(m, of, shifted(unsourced(of), shift), complete);
  }
  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of, const float& least,
                             const float& most, bool complete = false) noexcept {
    return prefix(m, of, shifted(unsourced(of), least, most), complete);
  }

  ETLMON_STEP Verdict sliding(uint32_t m, Sourced of) noexcept {
    return sliding(m, of, unsourced(of));
  }
  ETLMON_STEP Verdict sliding(uint32_t m, Sourced of, const float& shift) noexcept {
    return sliding(m, of, shifted(unsourced(of), shift));
  }
  ETLMON_STEP Verdict sliding(uint32_t m, Sourced of, const float& least,
                              const float& most) noexcept {
    return sliding(m, of, shifted(unsourced(of), least, most));
  }
  ETLMON_STEP Verdict undecided(uint32_t m) noexcept {
    keys_[m] = SourcedKey(0);
    return {};
  }

  SourcedKey operator[](uint32_t m) const noexcept { return keys_[m]; }

 private:
  /// Stores the bound that makes a verdict final, and nothing for an unknown verdict.
  ETLMON_STEP Verdict prefix(uint32_t m, const BasicReading<Sourced>& of, Reading said,
                             bool complete) noexcept {
    const int64_t holds = said.lower >= 0 ? of.lower.order : of.rho.low.order;
    const int64_t fails = said.upper < 0 ? of.upper.order : of.rho.high.order;
    decide(m, said.rho, holds, fails);
    return prefix_verdict(said.rho, said.lower, said.upper, complete);
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

/// Returns the sample of a value. `places`: predicates and bools in the order of the spec, with
/// `Codes` codes in all. `least`: the key from which on the verdict is satisfied.
template <uint32_t Codes, uint32_t Places>
Sample sample_of(SourcedKey value, const Place (&places)[Places], Key least = 0) noexcept {
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
  // A verdict is satisfied by low ends and violated by high ones, and a negation exchanges them.
  const bool within = !is_nan(place.inner) && (value.key() >= least) != Order::is_negated(rank);
  result.threshold = within ? place.inner : place.threshold;
  const uint32_t row = code - place.first;
  const bool names_rows = place.rows > 0;
  if (row == (names_rows ? place.rows : 1)) return result;  // the sample was missing
  const Key key = Order::is_negated(rank) ? -value.key() : value.key();
  result.robustness = float_of(key);
  result.distance = place.distance_at(key, result.threshold);
  if (names_rows) result.row = row;
  return result;
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
