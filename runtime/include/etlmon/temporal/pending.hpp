// SPDX-License-Identifier: MIT
// Formulas at the last positions of a prefix, whose windows extend beyond its end. Takes: readings
// of the operands at the last n positions, oldest first. Gives: readings of the formula there, by
// the definitions of robustness and bounds, with every window cut at the last position. Keeps true:
// the result at each position is exact for this prefix; the work is proportional to n for any
// windows. Reading: etlmon::Reading or BasicReading<Truth>.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/machine.hpp"
#include "etlmon/temporal/reading.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The last Length values of a stream.
template <class Value, uint32_t Length>
class Recent {
 public:
  constexpr void reset() noexcept { next_ = 0; }

  void push(Value value) noexcept {
    values_[next_] = value;
    next_ = next_ + 1 == Length ? 0 : next_ + 1;
  }

  /// Lists the last n <= Length values, oldest first, as settled readings.
  void list(BasicReading<Value>* out, uint32_t n) const noexcept {
    uint32_t at = next_ >= n ? next_ - n : next_ + Length - n;
    for (uint32_t p = 0; p < n; ++p) {
      out[p] = settled(values_[at]);
      at = at + 1 == Length ? 0 : at + 1;
    }
  }

 private:
  uint32_t next_;
  Value values_[Length];
};

namespace detail {
/// A parameter whose type is deduced from the others, so that nullptr may be passed.
template <class Same>
struct As {
  using Type = Same;
};
}  // namespace detail

/// The two kinds of future operators. F and U are max over a window, which later positions may
/// raise.
struct Seeking {
  template <class Value>
  static constexpr Value gain(Value a, Value b) noexcept {
    return max_of(a, b);
  }
  template <class Value>
  static constexpr Value keep(Value a, Value b) noexcept {
    return min_of(a, b);
  }
  template <class Value>
  static constexpr Value nothing() noexcept {
    return Lattice<Value>::bottom();
  }
  template <class Value>
  static constexpr Value all() noexcept {
    return Lattice<Value>::top();
  }
  /// The bound that unseen values affect.
  template <class Reading>
  static constexpr auto& open_end(Reading& reading) noexcept {
    return reading.upper;
  }
};

/// G and R are the dual.
struct Guarding {
  template <class Value>
  static constexpr Value gain(Value a, Value b) noexcept {
    return min_of(a, b);
  }
  template <class Value>
  static constexpr Value keep(Value a, Value b) noexcept {
    return max_of(a, b);
  }
  template <class Value>
  static constexpr Value nothing() noexcept {
    return Lattice<Value>::top();
  }
  template <class Value>
  static constexpr Value all() noexcept {
    return Lattice<Value>::bottom();
  }
  template <class Reading>
  static constexpr auto& open_end(Reading& reading) noexcept {
    return reading.lower;
  }
};

/// The end of an unbounded window.
constexpr uint32_t kWithoutEnd = 0xffffffffu;

template <class Reading>
void pending_and(const Reading* f, const Reading* g, Reading* out, uint32_t n) noexcept {
  for (uint32_t p = 0; p < n; ++p) out[p] = min_of(f[p], g[p]);
}

template <class Reading>
void pending_or(const Reading* f, const Reading* g, Reading* out, uint32_t n) noexcept {
  for (uint32_t p = 0; p < n; ++p) out[p] = max_of(f[p], g[p]);
}

/// Combines into out[p] the values of `in` over `length` positions from p + first on, cut at the
/// last one. In blocks of that length, a window is a suffix of one block and a prefix of the next.
template <class Reading, class Combine>
void pending_windows(const Reading* in, Reading* out, uint32_t n, uint32_t first, uint32_t length,
                     Combine combine) noexcept {
  if (first >= n || length == 0) return;
  const uint32_t last_block = (n - 1) / length * length;  // begin of the last block
  Reading part = in[n - 1];
  for (uint32_t at = n, begin = last_block; at-- > first;) {  // suffixes
    const bool ends = at + 1 == begin;
    if (ends) begin -= length;
    part = ends || at + 1 == n ? in[at] : combine(in[at], part);
    out[at - first] = combine(out[at - first], part);
  }
  for (uint32_t at = 0, begin = 0; at < n; ++at) {  // prefixes
    const bool begins = at == begin;
    if (begins) begin += length;
    part = begins ? in[at] : combine(part, in[at]);
    if (at + 1 < first + length) continue;
    Reading& whole = out[at + 1 - first - length];
    whole = combine(whole, part);
  }
  // Windows that extend beyond the last position.
  uint32_t p = n + 1 > first + length ? n + 1 - first - length : 0;
  for (; p + first < last_block; ++p) out[p] = combine(out[p], part);
}

/// Computes f U[low,high] g (Seeking) or f R[low,high] g (Guarding) at each position; without f
/// (nullptr), F and G. unseen: highest or lowest unseen value of g. f U[low,high] g is f at the
/// first low positions, then F[0,high-low] g and f U g, even if the prefix ends before.
template <class Sense, class Reading>
void pending_at_each(const typename detail::As<Reading>::Type* f, const Reading* g, Reading* out,
                     uint32_t n, uint32_t low, uint32_t high,
                     decltype(Reading::lower) unseen) noexcept {
  const auto gain = [](Reading etlmon_a, Reading etlmon_b) noexcept {
    return Sense::gain(etlmon_a, etlmon_b);
  };
  const auto keep = [](Reading etlmon_a, Reading etlmon_b) noexcept {
    return Sense::keep(etlmon_a, etlmon_b);
  };
  Reading beyond = Sense::template nothing<Reading>();
  Sense::open_end(beyond) = unseen;
  for (uint32_t p = 0; p < n; ++p)
    out[p] = high < n - p ? Sense::template nothing<Reading>() : beyond;
  low = low < n ? low : n;
  pending_windows(g, out, n, low, (high < n ? high : n) - low + 1, gain);
  if (f == nullptr) return;
  Reading until = beyond;
  for (uint32_t p = n; p-- > 0;) {
    if (p < n - low) until = gain(g[p + low], keep(f[p + low], until));
    out[p] = keep(out[p], until);
  }
  pending_windows(f, out, n, 0, low, keep);
}

/// Computes the operator at position 0 only, from operands that are settled `horizon` steps late: n
/// readings of them, the last at `step`. best and held: the operator and its left operand up to the
/// last settled position; both advance by one position.
template <class Sense, class Value>
BasicReading<Value> pending_from_start(Value& best, Value& held,
                                       const typename detail::As<BasicReading<Value>>::Type* f,
                                       const BasicReading<Value>* g, uint32_t n, uint32_t step,
                                       uint32_t horizon, uint32_t low, uint32_t high,
                                       typename Lattice<Value>::End unseen) noexcept {
  const auto open = [&](uint32_t etlmon_at) { return low <= etlmon_at && etlmon_at <= high; };
  uint32_t p = 0;
  uint32_t position = step + 1 - n;
  if (step >= horizon) {
    if (open(position)) best = Sense::gain(best, Sense::keep(held, g[0].rho));
    if (f != nullptr) held = Sense::keep(held, f[0].rho);
    ++p;
    ++position;
  }
  BasicReading<Value> result = settled(best);
  BasicReading<Value> left = settled(held);
  for (; p < n; ++p, ++position) {
    if (open(position)) result = Sense::gain(result, Sense::keep(left, g[p]));
    if (f != nullptr) left = Sense::keep(left, f[p]);
  }
  auto& end = Sense::open_end(result);
  if (high == kWithoutEnd || step < high)
    end = Sense::gain(end, Sense::keep(Sense::open_end(left), unseen));
  return result;
}

/// Runs a state machine whose guards are settled some steps late. guards: n rows of `width`, the
/// first of which is settled if `settles`; scratch: 2 * states readings; settled_guards: width +
/// states values. The settled row advances the registers.
template <class Value, class End>
BasicReading<Value> pending_machine(Value* registers, uint32_t states,
                                    const BasicReading<Value>* guards, uint32_t width, uint32_t n,
                                    bool settles, const Transition* transitions,
                                    const uint32_t* ends, const Obligations* pending,
                                    const End* weak, const End* strong,
                                    BasicReading<Value>* scratch, Value* settled_guards) noexcept {
  BasicReading<Value>* now = scratch;
  BasicReading<Value>* next = scratch + states;
  if (settles) {
    for (uint32_t g = 0; g < width; ++g) settled_guards[g] = guards[g].rho;
    Value* moved = settled_guards + width;
    machine_advance(registers, moved, states, transitions, ends, settled_guards);
    for (uint32_t q = 0; q < states; ++q) registers[q] = moved[q];
  }
  for (uint32_t q = 0; q < states; ++q) now[q] = settled(registers[q]);
  for (uint32_t p = settles ? 1 : 0; p < n; ++p) {
    machine_advance(now, next, states, transitions, ends, guards + p * width);
    BasicReading<Value>* const other = now;
    now = next;
    next = other;
  }
  return machine_read(now, states, pending, weak, strong);
}

/// The registers of such a machine; the rest is on the stack.
template <class Value, uint32_t States, uint32_t Width>
class PendingMachine {
  using End = typename Lattice<Value>::End;

 public:
  constexpr void reset() noexcept {
    for (uint32_t q = 0; q < States; ++q)
      registers_[q] = q == 0 ? Lattice<Value>::top() : Lattice<Value>::bottom();
  }

  BasicReading<Value> read(const BasicReading<Value> (*guards)[Width], uint32_t n, bool settles,
                           const Transition* transitions, const uint32_t* ends,
                           const Obligations* pending, const End* weak,
                           const End* strong) noexcept {
    BasicReading<Value> scratch[2 * States];
    Value values[Width + States];
    return pending_machine(registers_, States, guards[0], Width, n, settles, transitions, ends,
                           pending, weak, strong, scratch, values);
  }

 private:
  Value registers_[States];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
