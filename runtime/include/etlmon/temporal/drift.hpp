// SPDX-License-Identifier: MIT
// Do new episodes still look like those of calibration? Takes: the score of each new episode, and
// the scores of calibration as 8 cells. Gives: an alarm that is ever raised with probability at
// most `level` while all episodes are exchangeable. It is a conformal test martingale, the simple
// jumper (Vovk et al., "Retrain or not retrain", 2021), which bets on cells of exact probability
// (a Polya urn) in place of p-values. Keeps true: the state has a fixed size; wealth changes by
// regular ends of episodes only.
#pragma once

#include <stdint.h>

#include "etlmon/temporal/value.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

constexpr uint32_t kDriftCells = 8;

/// The n scores of calibration, ascending, leave n + 1 gaps; neighbours are merged into cells.
/// Each score has a random number, which decides between equal scores.
struct DriftCells {
  float ends[kDriftCells - 1];      ///< the score between a cell and the next
  uint32_t draws[kDriftCells - 1];  ///< its random number
  uint32_t gaps[kDriftCells];       ///< of each cell; their sum is n + 1
  float limit;                      ///< 1 / level
  uint32_t id;                      ///< of these numbers, not 0: no state of others is restored
};

/// All that has to survive a reboot.
struct DriftState {
  float accounts[3];             ///< of the bets on lower scores, on neither, and on higher ones
  uint32_t counts[kDriftCells];  ///< episodes since calibration, by the cell of their score
  uint32_t random;               ///< state of the generator; never 0
  uint32_t id;                   ///< DriftCells::id

  /// The factor by which bets have multiplied 1: the martingale.
  float wealth() const noexcept { return accounts[0] + accounts[1] + accounts[2]; }
  uint32_t episodes() const noexcept {
    uint32_t sum = 0;
    for (const uint32_t count : counts) sum += count;
    return sum;
  }
};

/// Watches the scores of one predicate or monitor. A greater score is less usual. The calls of one
/// object get the same cells.
class Drift {
 public:
  constexpr explicit Drift(const DriftCells& cells) noexcept : state_(first(cells)) {}

  static constexpr DriftState first(const DriftCells& cells) noexcept {
    return {{1.0f / 3, 1.0f / 3, 1.0f / 3}, {}, cells.id, cells.id};
  }

  /// Begins an episode, and forgets what was seen of one that did not end.
  constexpr void begin() noexcept { worst_ = kNone; }

  /// Adds a step. The score of an episode is the greatest of its steps; NaN is none.
  ETLMON_INLINE void see(const float& score) noexcept {
    if (!is_nan(score)) worst_ = max_of(worst_, key_of(score));
  }

  /// Counts the episode, unless it has no score, and begins the next. After an alarm nothing
  /// changes.
  void end(const DriftCells& cells) noexcept {
    const Key score = worst_;
    begin();
    if (score == kNone || alarm(cells) || state_.episodes() == UINT32_MAX) return;
    const uint32_t cell = cell_of(score, cells);
    bet(cell, cells);
    ++state_.counts[cell];
  }

  bool alarm(const DriftCells& cells) const noexcept { return state_.wealth() >= cells.limit; }
  const DriftState& state() const noexcept { return state_; }

  /// Restores what state() returned before a reboot. Returns false, and changes nothing, if it is
  /// of another calibration or no state, as erased flash memory.
  bool restore(const DriftState& saved, const DriftCells& cells) noexcept {
    bool sound = saved.id == cells.id && saved.random != 0;
    for (const float& account : saved.accounts)
      sound = sound && is_finite(account) && key_of(account) > 0;
    if (sound) state_ = saved;
    return sound;
  }

 private:
  static constexpr Key kNone = -0x7fffffff;  // below -inf

  /// The next number of Marsaglia's xorshift, from 1 to 2^32 - 1.
  uint32_t draw() noexcept {
    state_.random ^= state_.random << 13;
    state_.random ^= state_.random >> 17;
    return state_.random ^= state_.random << 5;
  }

  uint32_t cell_of(Key score, const DriftCells& cells) noexcept {
    const uint32_t drawn = draw();
    uint32_t cell = 0;
    for (uint32_t i = 0; i + 1 < kDriftCells; ++i) {
      const Key end = key_of(cells.ends[i]);
      cell += score > end || (score == end && drawn > cells.draws[i]) ? 1 : 0;
    }
    return cell;
  }

  /// Multiplies each account by 1 + e (x - E x), e = -1, 0, 1, where x = (cell + 1/2) / 8, and
  /// shares out a hundredth of their sum. Cell i has the probability (gaps[i] + counts[i]) / sum.
  void bet(uint32_t cell, const DriftCells& cells) noexcept {
    uint64_t sum = 0, mean = 0;
    for (uint32_t i = 0; i < kDriftCells; ++i) {
      const uint64_t weight = uint64_t{cells.gaps[i]} + state_.counts[i];
      sum += weight;
      mean += weight * i;
    }
    const float apart =
        (static_cast<float>(cell) - static_cast<float>(mean) / static_cast<float>(sum)) /
        kDriftCells;
    state_.accounts[0] *= 1 - apart;
    state_.accounts[2] *= 1 + apart;
    const float share = 0.01f / 3 * state_.wealth();
    for (float& account : state_.accounts) account = 0.99f * account + share;
  }

  DriftState state_;
  Key worst_ = kNone;  ///< key of the greatest score of this episode
};

static_assert(sizeof(Drift) <= 64, "the state is small");

}  // namespace ETLMON_BUILD
}  // namespace etlmon
