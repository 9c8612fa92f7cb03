// SPDX-License-Identifier: MIT
// A trial of new parameters: a second monitor with them runs beside the active one, and differences
// are counted before they are adopted. Takes: the inputs of each step, once. Gives: the verdicts of
// the active monitor, and the counts. Keeps true: the monitors share nothing; nothing is allocated.
#pragma once

#include "etlmon/params/params.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// The differences of one monitor of the spec since the trial began. All counters saturate.
struct ShadowCount {
  uint32_t steps = 0;   ///< steps of both
  uint32_t status = 0;  ///< of these, with a different status: satisfied, violated, decided or
                        ///< final
  uint32_t alarm = 0;   ///< of these, with an alarm of only one
};

/// `Monitor`: a retargetable class, with its inputs, its verdicts, and their number.
template <class Monitor, class Inputs, class Verdicts, uint32_t monitors>
class Shadow {
 public:
  constexpr Shadow() noexcept = default;
  constexpr explicit Shadow(const Monitor& etlmon_active) noexcept : active_(etlmon_active) {}

  /// The active monitor and the candidate. Call restart_M() and the like on both.
  Monitor& active() noexcept { return active_; }
  const Monitor& active() const noexcept { return active_; }
  Monitor& candidate() noexcept { return candidate_; }
  const Monitor& candidate() const noexcept { return candidate_; }
  bool on_trial() const noexcept { return on_trial_; }

  /// Begins a trial with new counts: the candidate is a copy of the active monitor with these
  /// parameters. If they are not ready, nothing changes.
  template <class Params>
  ParamsState try_out(const Params& params, Past past) noexcept {
    if (!params.ready()) return params.state();
    candidate_ = active_;
    candidate_.retarget(params, past);
    for (ShadowCount& count : counts_) count = ShadowCount();
    on_trial_ = true;
    return params.state();
  }
  /// Ends the trial: the candidate becomes active from the next step on. Returns false if there is
  /// no trial.
  bool promote() noexcept {
    if (!on_trial_) return false;
    active_ = candidate_;
    on_trial_ = false;
    return true;
  }
  /// Ends the trial, and keeps the active monitor.
  void drop() noexcept { on_trial_ = false; }

  /// Steps both, and returns the verdicts of the active one.
  Verdicts step(const Inputs& in) noexcept {
    const Verdicts answers = active_.step(in);
    if (on_trial_) count(answers, candidate_.step(in));
    return answers;
  }
  /// Calls finish() of both; only with sliding monitors.
  Verdicts finish() noexcept {
    const Verdicts answers = active_.finish();
    if (on_trial_) count(answers, candidate_.finish());
    return answers;
  }
  /// Starts a new episode of both; a trial goes on, with its counts.
  void reset() noexcept {
    active_.reset();
    candidate_.reset();
  }

  /// Returns the differences of monitor m, in the order of the spec; they are kept until the next
  /// trial.
  const ShadowCount& count_of(uint32_t m) const noexcept { return counts_[m]; }

 private:
  static void add(uint32_t& counter, bool one) noexcept {
    if (one && counter != UINT32_MAX) ++counter;
  }
  void count(const Verdicts& answers, const Verdicts& candidates) noexcept {
    const auto one = named(answers);
    const auto other = named(candidates);
    for (uint32_t m = 0; m < monitors; ++m) {
      const auto& a = one.entries[m].verdict;
      const auto& b = other.entries[m].verdict;
      add(counts_[m].steps, true);
      add(counts_[m].status, a.status != b.status);
      add(counts_[m].alarm, a.alarm() != b.alarm());
    }
  }

  Monitor active_{};
  Monitor candidate_{};
  ShadowCount counts_[monitors] = {};
  bool on_trial_ = false;
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
