// SPDX-License-Identifier: MIT
// Several windows that watch one signal, each made from a shorter one.
// Takes: one aggregate of a shorter window a step. Gives: that of a longer one. Keeps true: the
// results of a window of its own, in one combination a step.
#pragma once

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/monoid.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// From the aggregate of the last M to that of the last N of one stream, M < N <= 2 M: one
/// combination and a delay by N - M instead of a second window, where several windows watch one
/// signal. Only for operators whose segments may overlap.
template <class Monoid, uint32_t Shorter, uint32_t Length>
class Widening {
  static_assert(Shorter < Length && Length - Shorter <= Shorter,
                "the two shorter windows must meet");
  static_assert(Monoid::kMayOverlap, "an element that both windows hold would count twice");

 public:
  using Element = typename Monoid::Element;

  /// Forgets all elements; time proportional to N - M.
  constexpr void reset() noexcept { past_.reset(Monoid::identity()); }

  /// Takes this step's aggregate of the last M, gives that of the last N.
  ETLMON_STEP Element push(Element aggregate) noexcept {
    return Monoid::combine(past_.push(aggregate), aggregate);
  }

 private:
  Delay<Element, Length - Shorter> past_;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
