// SPDX-License-Identifier: MIT
// Windows over one signal, each computed from a shorter one. Takes: the aggregate of a shorter
// window at each step. Gives: that of a longer one. Keeps true: the results of a separate window,
// with one combination per step.
#pragma once

#include "etlmon/temporal/delay.hpp"
#include "etlmon/temporal/monoid.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// Widens the aggregate of the last Shorter elements to the last Length, Shorter < Length <= 2
/// Shorter, by a combination and a delay in place of a second window. For operators whose segments
/// may overlap.
template <class Monoid, uint32_t Shorter, uint32_t Length>
class Widening {
  static_assert(Shorter < Length && Length - Shorter <= Shorter,
                "the two shorter windows must meet");
  static_assert(Monoid::kMayOverlap, "an element that both windows hold would count twice");

 public:
  using Element = typename Monoid::Element;

  /// Forgets all elements; takes time proportional to Length - Shorter.
  constexpr void reset() noexcept { past_.reset(Monoid::identity()); }

  /// Takes this step's aggregate of the last Shorter elements, returns that of the last Length.
  ETLMON_STEP Element push(Element aggregate) noexcept {
    return Monoid::combine(past_.push(aggregate), aggregate);
  }

 private:
  Delay<Element, Length - Shorter> past_;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
