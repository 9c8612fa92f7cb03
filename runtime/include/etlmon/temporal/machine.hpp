// SPDX-License-Identifier: MIT
// A weighted state machine over (max, min), as constant tables and one loop. Takes: the guards'
// values at this step. Gives: the reading of the formula. Keeps true: next[t] is the max over the
// transitions into t of min(now[source], guard), so that the max over the states without pending
// obligations is rho on the prefix. Every step takes one min and one max per transition.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/reading.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

struct Transition {
  uint16_t source;
  uint16_t guard;
};

/// The pending obligations of a state at the end of the prefix, as indices into this step's keys.
struct Obligations {
  uint16_t weak;  ///< lowest unseen value of weak obligations; kStrongly: some obligation is strong
  uint16_t strong;  ///< highest unseen value of strong obligations; 0 is kTop: none
};
constexpr uint16_t kStrongly = 0xffff;

/// Computes next. The transitions into state t follow those into t - 1, and end before index
/// ends[t].
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

/// Reads the machine. rho: max over states without strong obligations. lower: the same, with weak
/// obligations at their lowest unseen value. upper: max over all states, with strong obligations at
/// their highest unseen value.
template <class Value, class End>
auto machine_read(const Value* now, uint32_t states, const Obligations* pending, const End* weak,
                  const End* strong) noexcept {
  using Result = decltype(reading_of(*now));
  Result reading = Lattice<Result>::bottom();
  for (uint32_t q = 0; q < states; ++q) {
    const Result at = reading_of(now[q]);
    reading.upper = max_of(reading.upper, min_of(at.upper, strong[pending[q].strong]));
    if (pending[q].weak == kStrongly) continue;
    reading.rho = max_of(reading.rho, at.rho);
    reading.lower = max_of(reading.lower, min_of(at.lower, weak[pending[q].weak]));
  }
  return reading;
}

/// The registers of a machine; its tables are arguments. State 0 is the initial state.
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

  BasicReading<Value> read(const Obligations* pending, const End* weak,
                           const End* strong) const noexcept {
    return machine_read(registers_[turn_], States, pending, weak, strong);
  }

 private:
  uint32_t turn_;
  Value registers_[2][States];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
