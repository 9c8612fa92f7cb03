// SPDX-License-Identifier: MIT
// A weighted state machine over (max, min), as constant tables and one loop.
// Takes: the guards' values at this step. Gives: the reading of the formula. Keeps true: next[t] is
// the max over the transitions into t of min(now[source], guard), so that the max over the states
// that owe nothing is rho on the prefix; the work is the same at every step: one min and one max a
// transition.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/reading.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

struct Transition {
  uint16_t source;
  uint16_t guard;
};

/// What a state is worth where the prefix ends: indices into this step's lists of keys.
struct Owed {
  uint16_t weak;  ///< lowest unseen value of what it owes weakly; kStrongly: it owes something that
                  ///< must still come
  uint16_t strong;  ///< highest unseen value of what it owes strongly; 0 is kTop: nothing
};
constexpr uint16_t kStrongly = 0xffff;

/// The transitions into state t end at ends[t]; those of t follow those of t - 1.
template <class Value>
void machine_advance(const Value* now, Value* next, uint32_t states, const Transition* transitions,
                     const uint32_t* ends, const Value* guards) noexcept {
  uint32_t at = 0;
  for (uint32_t target = 0; target < states; ++target) {
    Value best = Lattice<Value>::bottom();
    for (; at < ends[target]; ++at)
      best = max_of(best, min_of(now[transitions[at].source], guards[transitions[at].guard]));
    next[target] = best;
  }
}

/// rho: the best state that owes nothing strongly. lower: what it owes weakly is worth its lowest
/// unseen value. upper: any state, what it owes strongly is worth its highest unseen value.
template <class Value, class End>
auto machine_read(const Value* now, uint32_t states, const Owed* owed, const End* weak,
                  const End* strong) noexcept {
  using Result = decltype(reading_of(*now));
  Result reading = Lattice<Result>::bottom();
  for (uint32_t q = 0; q < states; ++q) {
    const Result at = reading_of(now[q]);
    reading.upper = max_of(reading.upper, min_of(at.upper, strong[owed[q].strong]));
    if (owed[q].weak == kStrongly) continue;
    reading.rho = max_of(reading.rho, at.rho);
    reading.lower = max_of(reading.lower, min_of(at.lower, weak[owed[q].weak]));
  }
  return reading;
}

/// The registers of a machine with its tables elsewhere; state 0 is the initial one.
template <class Value, uint32_t States>
class Machine {
  using End = typename Lattice<Value>::End;

 public:
  constexpr void reset() noexcept {
    turn_ = 0;
    for (uint32_t q = 0; q < States; ++q)
      registers_[0][q] = q == 0 ? Lattice<Value>::top() : Lattice<Value>::bottom();
  }

  void advance(const Transition* transitions, const uint32_t* ends, const Value* guards) noexcept {
    machine_advance(registers_[turn_], registers_[1 - turn_], States, transitions, ends, guards);
    turn_ = 1 - turn_;
  }

  BasicReading<Value> read(const Owed* owed, const End* weak, const End* strong) const noexcept {
    return machine_read(registers_[turn_], States, owed, weak, strong);
  }

 private:
  uint32_t turn_;
  Value registers_[2][States];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
