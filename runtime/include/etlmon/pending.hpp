// SPDX-License-Identifier: MIT
// Formulas at the last positions of a prefix, whose windows still reach past its end.
// Takes: readings of the operands at n positions, oldest first, the last one being the present. Gives: readings of the
// formula there, by the definitions of robustness and of the bounds, every window cut at the present.
// Keeps true: position p tells exactly what rho and the bounds of the operator are there on this prefix; the work is at
// most n times the window.
#pragma once

#include <stdint.h>

#include "etlmon/machine.hpp"
#include "etlmon/reading.hpp"

namespace etlmon {

/// The last N values of a stream.
template <uint32_t N>
class Recent {
 public:
  void reset() noexcept { next_ = 0; }

  void push(Value value) noexcept {
    values_[next_] = value;
    next_ = next_ + 1 == N ? 0 : next_ + 1;
  }

  /// The last n <= N, oldest first, as readings of settled values.
  void list(Reading* out, uint32_t n) const noexcept {
    uint32_t at = next_ >= n ? next_ - n : next_ + N - n;
    for (uint32_t p = 0; p < n; ++p) {
      out[p] = settled(values_[at]);
      at = at + 1 == N ? 0 : at + 1;
    }
  }

 private:
  Value values_[N];
  uint32_t next_;
};

constexpr Reading kReadsTrue{kTrue, kTop, kTop};
constexpr Reading kReadsFalse{kFalse, kBottom, kBottom};

template <>
struct Lattice<Reading> {
  static constexpr Reading bottom() noexcept { return kReadsFalse; }
  static constexpr Reading top() noexcept { return kReadsTrue; }
};

/// The upper bound of a window without one.
constexpr uint32_t kWithoutEnd = 0xffffffffu;

/// One past the last position of a window up to `high`, cut at the present.
constexpr uint32_t window_end(uint32_t from, uint32_t high, uint32_t n) noexcept {
  return high < n - from ? from + high + 1 : n;
}

inline void pending_and(const Reading* f, const Reading* g, Reading* out, uint32_t n) noexcept {
  for (uint32_t p = 0; p < n; ++p) out[p] = min(f[p], g[p]);
}

inline void pending_or(const Reading* f, const Reading* g, Reading* out, uint32_t n) noexcept {
  for (uint32_t p = 0; p < n; ++p) out[p] = max(f[p], g[p]);
}

/// f U[low,high] g; F is U with f true. unseen: the highest unseen value of g.
inline void pending_until(const Reading* f, const Reading* g, Reading* out, uint32_t n, uint32_t low, uint32_t high,
                          Key unseen) noexcept {
  for (uint32_t p = 0; p < n; ++p) {
    Reading best = kReadsFalse;
    Reading held = kReadsTrue;
    const uint32_t end = window_end(p, high, n);
    for (uint32_t j = p; j < end; ++j) {
      if (j - p >= low) best = max(best, min(held, g[j]));
      if (f != nullptr) held = min(held, f[j]);
    }
    if (high >= n - p) best.upper = max(best.upper, min(held.upper, unseen));
    out[p] = best;
  }
}

/// f R[low,high] g; G is R with f false. unseen: the lowest unseen value of g.
inline void pending_release(const Reading* f, const Reading* g, Reading* out, uint32_t n, uint32_t low, uint32_t high,
                            Key unseen) noexcept {
  for (uint32_t p = 0; p < n; ++p) {
    Reading worst = kReadsTrue;
    Reading freed = kReadsFalse;
    const uint32_t end = window_end(p, high, n);
    for (uint32_t j = p; j < end; ++j) {
      if (j - p >= low) worst = min(worst, max(freed, g[j]));
      if (f != nullptr) freed = max(freed, f[j]);
    }
    if (high >= n - p) worst.lower = min(worst.lower, max(freed.lower, unseen));
    out[p] = worst;
  }
}

/// f U[low,high] g (f nullptr: F) from position 0, its operands settled `horizon` steps late. `n` readings of them, the
/// last at `step`. best and held: the operator and its left side up to the last settled position; both are moved on by
/// one.
inline Reading pending_until_from_start(Value& best, Value& held, const Reading* f, const Reading* g, uint32_t n,
                                        uint32_t step, uint32_t horizon, uint32_t low, uint32_t high,
                                        Key unseen) noexcept {
  const auto open = [&](uint32_t position) { return low <= position && position <= high; };
  uint32_t p = 0;
  uint32_t position = step + 1 - n;
  if (step >= horizon) {
    if (open(position)) best = max(best, min(held, g[0].rho));
    if (f != nullptr) held = min(held, f[0].rho);
    ++p, ++position;
  }
  Reading result = settled(best);
  Reading left = settled(held);
  for (; p < n; ++p, ++position) {
    if (open(position)) result = max(result, min(left, g[p]));
    if (f != nullptr) left = min(left, f[p]);
  }
  if (high == kWithoutEnd || step < high) result.upper = max(result.upper, min(left.upper, unseen));
  return result;
}

/// f R[low,high] g (f nullptr: G), the dual.
inline Reading pending_release_from_start(Value& worst, Value& freed, const Reading* f, const Reading* g, uint32_t n,
                                          uint32_t step, uint32_t horizon, uint32_t low, uint32_t high,
                                          Key unseen) noexcept {
  const auto open = [&](uint32_t position) { return low <= position && position <= high; };
  uint32_t p = 0;
  uint32_t position = step + 1 - n;
  if (step >= horizon) {
    if (open(position)) worst = min(worst, max(freed, g[0].rho));
    if (f != nullptr) freed = max(freed, f[0].rho);
    ++p, ++position;
  }
  Reading result = settled(worst);
  Reading left = settled(freed);
  for (; p < n; ++p, ++position) {
    if (open(position)) result = min(result, max(left, g[p]));
    if (f != nullptr) left = max(left, f[p]);
  }
  if (high == kWithoutEnd || step < high) result.lower = min(result.lower, max(left.lower, unseen));
  return result;
}

/// A state machine whose guards are settled some steps late. guards: n rows of `width`, the first one settled where
/// `settles`; scratch: 2 * states readings; settled_guards: width + states values. Its registers are moved on by the
/// settled row.
inline Reading pending_machine(Value* registers, uint32_t states, const Reading* guards, uint32_t width, uint32_t n,
                               bool settles, const Transition* transitions, const uint32_t* ends, const Owed* owed,
                               const Key* weak, const Key* strong, Reading* scratch, Value* settled_guards) noexcept {
  Reading* now = scratch;
  Reading* next = scratch + states;
  if (settles) {
    for (uint32_t g = 0; g < width; ++g) settled_guards[g] = guards[g].rho;
    Value* moved = settled_guards + width;
    machine_advance(registers, moved, states, transitions, ends, settled_guards);
    for (uint32_t q = 0; q < states; ++q) registers[q] = moved[q];
  }
  for (uint32_t q = 0; q < states; ++q) now[q] = settled(registers[q]);
  for (uint32_t p = settles ? 1 : 0; p < n; ++p) {
    machine_advance(now, next, states, transitions, ends, guards + p * width);
    Reading* const other = now;
    now = next;
    next = other;
  }
  return machine_read(now, states, owed, weak, strong);
}

/// Its registers, with room on the stack for the rest.
template <uint32_t States, uint32_t Width>
class PendingMachine {
 public:
  void reset() noexcept {
    for (uint32_t q = 0; q < States; ++q) registers_[q] = q == 0 ? kTrue : kFalse;
  }

  Reading read(const Reading (*guards)[Width], uint32_t n, bool settles, const Transition* transitions,
               const uint32_t* ends, const Owed* owed, const Key* weak, const Key* strong) noexcept {
    Reading scratch[2 * States];
    Value values[Width + States];
    return pending_machine(registers_, States, guards[0], Width, n, settles, transitions, ends, owed, weak, strong,
                           scratch, values);
  }

 private:
  Value registers_[States];
};

}  // namespace etlmon
