// SPDX-License-Identifier: MIT
// Robustness that carries its sample: the values of a class generated with --explain. Takes: values
// of a step, the step, and a code per sample, which encodes its predicate or bool and the nearest
// row. Gives: a value type for the temporal operators and machines. Keeps true: the keys are those
// of robustness, so verdicts have the same bits; values are totally ordered, so min and max return
// one of their operands, with its sample. Of equal keys, that of the earlier sample is farther from
// 0, at one step that of the first in the spec; true and false are farthest, unseen values nearest.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/shift.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "etlmon/temporal/window.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The order of samples: earlier ones are farther from the middle, above it for keys >= 0 and below
/// it for negative keys. So comparing keys, then ranks, puts equal keys of earlier samples farther
/// from 0. Ranks below the middle are complements; a negated rank is one less, as its lowest bit
/// shows.
using Rank = uint32_t;
constexpr Rank kUnseen = 0x80000000u;  ///< the middle: of unseen values
constexpr Rank kItself = 0x7fffffffu;  ///< distance of true and false: beyond any sample

// Two words, so that state has no padding on any target.
#pragma pack(push, 4)
/// A key and, in the lower half, the rank of its sample. A key alone has no sample.
struct SourcedKey {
  int64_t order;

  SourcedKey() noexcept = default;
  constexpr SourcedKey(Key etlmon_key, Rank etlmon_rank) noexcept
      : order(static_cast<int64_t>(static_cast<uint64_t>(static_cast<uint32_t>(etlmon_key)) << 32 |
                                   etlmon_rank)) {}
  constexpr SourcedKey(Key etlmon_key) noexcept
      : SourcedKey(etlmon_key, etlmon_key == kTop      ? kUnseen + kItself
                               : etlmon_key == kBottom ? kUnseen - kItself - 1
                                                       : kUnseen) {}
  static constexpr SourcedKey of(int64_t order) noexcept {
    SourcedKey result(0);
    result.order = order;
    return result;
  }

  constexpr Rank rank() const noexcept { return static_cast<Rank>(static_cast<uint64_t>(order)); }
  constexpr Key key() const noexcept {
    return static_cast<Key>(static_cast<uint32_t>(static_cast<uint64_t>(order) >> 32));
  }
};
#pragma pack(pop)

/// A range of robustness; each end carries its sample.
struct Sourced {
  SourcedKey low;
  SourcedKey high;

  Sourced() noexcept = default;
  constexpr Sourced(SourcedKey etlmon_low, SourcedKey etlmon_high) noexcept
      : low(etlmon_low), high(etlmon_high) {}
  constexpr Sourced(Value etlmon_value) noexcept : low(etlmon_value.low), high(etlmon_value.high) {}
};
static_assert(sizeof(Sourced) == 16 && alignof(Sourced) == 4, "twice a value");

constexpr Sourced kTrueItself{kTrue};
constexpr Sourced kFalseItself{kFalse};

// On numbers, which compilers select without a branch, unlike structs.
constexpr SourcedKey min_of(SourcedKey a, SourcedKey b) noexcept {
  return SourcedKey::of(b.order < a.order ? b.order : a.order);
}
constexpr SourcedKey max_of(SourcedKey a, SourcedKey b) noexcept {
  return SourcedKey::of(a.order < b.order ? b.order : a.order);
}
constexpr bool exceeds(SourcedKey a, SourcedKey b) noexcept { return b.order < a.order; }
constexpr Sourced min_of(Sourced a, Sourced b) noexcept {
  return {min_of(a.low, b.low), min_of(a.high, b.high)};
}
constexpr Sourced max_of(Sourced a, Sourced b) noexcept {
  return {max_of(a.low, b.low), max_of(a.high, b.high)};
}
/// Negates both the key and the rank.
constexpr SourcedKey negate(SourcedKey a) noexcept {
  return SourcedKey::of(int64_t{0xfffffffe} - a.order);
}
constexpr Sourced negate(Sourced a) noexcept { return {negate(a.high), negate(a.low)}; }

/// A value kept between steps. Its ends have two types, as those of Register.
struct SourcedRegister {
#pragma pack(push, 4)
  struct End {
    uint64_t order;
    End() noexcept = default;
    constexpr End(Key etlmon_key) noexcept
        : order(static_cast<uint64_t>(SourcedKey(etlmon_key).order)) {}
    constexpr operator SourcedKey() const noexcept {
      return SourcedKey::of(static_cast<int64_t>(order));
    }
  };
#pragma pack(pop)
  SourcedKey low;
  End high;

  constexpr operator Sourced() const noexcept { return {SourcedKey::of(low.order), high}; }
  ETLMON_INLINE constexpr SourcedRegister& operator=(Sourced value) noexcept {
    low.order = value.low.order;
    high.order = static_cast<uint64_t>(value.high.order);
    return *this;
  }
};
static_assert(sizeof(SourcedRegister) == sizeof(Sourced), "what the budget counts");

template <>
struct Lattice<SourcedKey> {
  using End = SourcedKey;
  static constexpr SourcedKey bottom() noexcept { return kBottom; }
  static constexpr SourcedKey top() noexcept { return kTop; }
};

template <>
struct Lattice<Sourced> {
  using End = SourcedKey;
  static constexpr Sourced bottom() noexcept { return kFalseItself; }
  static constexpr Sourced top() noexcept { return kTrueItself; }
};

/// Returns the reading of a settled register.
constexpr BasicReading<Sourced> settled(SourcedRegister kept) noexcept {
  return settled<Sourced>(kept);
}

constexpr SourcedKey low_of(Sourced v) noexcept { return v.low; }
constexpr SourcedKey high_of(Sourced v) noexcept { return v.high; }
constexpr Sourced pair_of(SourcedKey low, SourcedKey high) noexcept { return {low, high}; }
constexpr bool same_ends(Sourced v) noexcept { return v.low.order == v.high.order; }

template <template <class> class Operator, uint32_t Length>
class Window<Operator<Sourced>, Length> : public PairWindow<Operator, Sourced, Length> {};

/// Returns a value with the sample of this rank, which is above the middle.
ETLMON_INLINE SourcedKey sourced(Key key, Rank rank) noexcept {
  return {key, rank ^ static_cast<uint32_t>(key >> 31)};
}
ETLMON_INLINE Sourced sourced(Value value, Rank rank) noexcept {
  return {sourced(value.low, rank), sourced(value.high, rank)};
}

/// The ranks of samples: `count` codes per step, in the order of the spec. Steps beyond the last
/// distinct one share its ranks, and are not reported.
template <uint32_t count>
struct Ranks {
  static constexpr uint32_t kSamples = kItself / 2 - 1;
  static constexpr uint32_t kLastStep = kSamples / count - 1;

  /// Returns the rank of code 0 of a step; that of code n is 2 n less.
  static constexpr Rank first(uint32_t step) noexcept {
    return kUnseen + 2 * (kSamples - (step < kLastStep ? step : kLastStep) * count);
  }
  static constexpr bool is_sample(Rank rank) noexcept {
    return earliness(rank) != 0 && earliness(rank) <= kSamples;
  }
  static constexpr uint32_t code(Rank rank) noexcept { return number(rank) % count; }
  static constexpr uint32_t step(Rank rank) noexcept { return number(rank) / count; }
  static constexpr bool is_negated(Rank rank) noexcept {
    return (rank & 1) == (rank < kUnseen ? 0 : 1);
  }

 private:
  static constexpr uint32_t earliness(Rank rank) noexcept {
    return (rank < kUnseen ? ~rank - kUnseen : rank - kUnseen + 1) / 2;
  }
  static constexpr uint32_t number(Rank rank) noexcept { return kSamples - earliness(rank); }
};

/// Shifts the keys, and keeps the samples.
ETLMON_INLINE Value unsourced(Sourced value) noexcept {
  return {value.low.key(), value.high.key()};
}
ETLMON_INLINE Reading unsourced(BasicReading<Sourced> reading) noexcept {
  return {unsourced(reading.rho), reading.lower.key(), reading.upper.key()};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
