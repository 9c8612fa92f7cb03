// SPDX-License-Identifier: MIT
// The flight recorder: what the monitors saw and said around each alarm.
// Takes: a row a step, with the status of every verdict. Gives: incidents, each the steps around an
// alarm, as bytes of the form that docs/data.md describes. Keeps true: no heap; a step copies its
// row once, and a row that an incident needs once more, BEFORE steps later; a complete incident
// does not change until it is forgotten, so it may be written while steps go on; what is written
// is little-endian and the same on every machine.
#pragma once

#include "etlmon/checksum.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// In a row: nobody asked for the predicate. A sample that is missing has kMissingBits.
constexpr uint32_t kUnaskedBits = 0x7fc00001u;
/// Of bools in a row: false, true, missing, and where nobody asked.
constexpr uint8_t kRecordedFalse = 0, kRecordedTrue = 1, kRecordedMissing = 2, kRecordedUnasked = 3;
/// Beside the bits of Answers in a recorded status: an alarm begins at this step.
constexpr uint8_t kAlarmBegins = 16;

/// "\x89ETLINC\n": the byte that is no text shows what has been through a conversion of text.
constexpr uint8_t kIncidentMagic[8] = {0x89, 'E', 'T', 'L', 'I', 'N', 'C', '\n'};
constexpr uint32_t kIncidentVersion = 1;
constexpr uint32_t kIncidentHeadBytes = 96;
constexpr uint32_t kIncidentChecksumBytes = 8;

/// What is recorded of a step: its number, a word for each figure of a predicate, a byte for each
/// bool and each verdict.
template <uint32_t Figures, uint32_t Bools, uint32_t Monitors>
struct RecorderRow {
  static constexpr uint32_t kWords = 1 + Figures;
  static constexpr uint32_t kBytes = Bools + Monitors;
  static constexpr uint32_t kPaddedBytes = (kBytes + 3) / 4 * 4;
  static constexpr uint32_t kBools = Bools;
  static constexpr uint32_t kMonitors = Monitors;

  uint32_t words[kWords];
  uint8_t bytes[kPaddedBytes];

  /// A step at which nobody asked for anything.
  RecorderRow() noexcept {
    words[0] = 0;
    for (uint32_t i = 1; i < kWords; ++i) words[i] = kUnaskedBits;
    for (uint32_t i = 0; i < kPaddedBytes; ++i) bytes[i] = i < Bools ? kRecordedUnasked : 0;
  }

  /// A distance, an expression or a threshold; every NaN is recorded alike.
  void figure(uint32_t at, const float& x) noexcept {
    words[1 + at] = is_nan(x) ? detail::kMissingBits : detail::observe(x);
  }
  /// A distance and the row of the nearest target.
  void figures(uint32_t at, const float& delta, uint32_t nearest) noexcept {
    figure(at, delta);
    this->nearest(at + 1, nearest);
  }
  /// That row alone, beside an expression.
  void nearest(uint32_t at, uint32_t row) noexcept { words[1 + at] = row; }
  void flag(uint32_t at, const Flag& x) noexcept {
    bytes[at] = x.present() ? (x.value() ? kRecordedTrue : kRecordedFalse) : kRecordedMissing;
  }
};

/// What the monitor was made from, as the head of an incident says it.
struct IncidentOrigin {
  uint64_t spec;
  uint64_t data;
  uint64_t thresholds;
  uint64_t columns;  ///< of what the rows hold
};

namespace detail {

/// Bytes on their way out: 32 at a time, as the checksum takes them.
template <class Sink>
class IncidentWriter {
 public:
  explicit IncidentWriter(Sink& sink) noexcept : sink_(sink) {}

  void byte(uint8_t x) {
    block_[count_++] = x;
    if (count_ < sizeof block_) return;
    checksum_.add(block_, sizeof block_);
    sink_(static_cast<const uint8_t*>(block_), sizeof block_);
    count_ = 0;
  }
  void word(uint32_t x) {
    for (uint32_t i = 0; i < 4; ++i) byte(static_cast<uint8_t>(x >> (8 * i)));
  }
  void long_word(uint64_t x) {
    word(static_cast<uint32_t>(x));
    word(static_cast<uint32_t>(x >> 32));
  }
  /// Zeros up to a multiple of 32, and the checksum of all bytes so far.
  void finish() {
    while (count_ > 0) byte(0);
    const uint64_t sum = checksum_.value();
    const uint32_t halves[] = {static_cast<uint32_t>(sum), static_cast<uint32_t>(sum >> 32)};
    for (uint32_t i = 0; i < kIncidentChecksumBytes; ++i)
      block_[i] = static_cast<uint8_t>(halves[i / 4] >> (8 * (i % 4)));
    sink_(static_cast<const uint8_t*>(block_), size_t{kIncidentChecksumBytes});
  }

 private:
  Sink& sink_;
  Checksum checksum_;
  uint8_t block_[32];
  uint32_t count_ = 0;
};

}  // namespace detail

/// A ring of the last Before steps and this one, and a log of the steps that incidents hold. A row
/// leaves the ring for the log if an incident holds it; incidents that overlap share its rows. The
/// first Incidents alarms are kept; later ones are counted as lost, until forget().
template <class Row, uint32_t Before, uint32_t After, uint32_t Incidents>
class Recorder {
  static constexpr uint32_t kRing = Before + 1;
  static constexpr uint32_t kLog = Incidents * (Before + 1 + After);
  static constexpr uint32_t kAlarmWords = (Row::kMonitors + 31) / 32;
  static constexpr uint32_t kAlarm = Verdict::kViolated | Verdict::kFinal;

 public:
  Recorder() noexcept { end_episode(); }

  /// After each step. `statuses`: of the verdicts, in the order of the spec. An alarm begins where
  /// a verdict is one that was none at the step before.
  void record(const Row& row, const uint32_t (&statuses)[Row::kMonitors]) noexcept {
    if (count_ == kRing) take_oldest();
    Row& here = ring_[in_ring(count_)];
    ++count_;
    here = row;
    here.words[0] = step_;
    if (step_ != UINT32_MAX) ++step_;
    bool begins = false;
    for (uint32_t m = 0; m < Row::kMonitors; ++m) {
      uint32_t& alarms = alarms_[m / 32];
      const uint32_t bit = uint32_t{1} << (m % 32);
      const bool alarm = (statuses[m] & kAlarm) == kAlarm;
      const bool first = alarm && (alarms & bit) == 0;
      alarms = alarm ? alarms | bit : alarms & ~bit;
      here.bytes[Row::kBools + m] = static_cast<uint8_t>(statuses[m] | (first ? kAlarmBegins : 0u));
      begins = begins || first;
    }
    if (begins) begin_incident();
  }

  /// Monitor m restarted: its next alarm is another one.
  void restart(uint32_t m) noexcept { alarms_[m / 32] &= ~(uint32_t{1} << (m % 32)); }

  /// A new episode: no step before it counts.
  void end_episode() noexcept {
    close();
    oldest_ = count_ = 0;
    if (step_ != 0 && episode_ != UINT32_MAX) ++episode_;
    step_ = 0;
    for (uint32_t i = 0; i < kAlarmWords; ++i) alarms_[i] = 0;
  }

  /// Completes the incidents that wait for steps, with those that there are.
  void close() noexcept {
    for (uint32_t i = 0; i < count_ && owed_ > 0; ++i, --owed_) log_[logged_++] = ring_[in_ring(i)];
    owed_ = 0;
    for (uint32_t n = complete(); n < begun_; ++n)
      incidents_[n].length = logged_ - incidents_[n].first;
  }

  /// Room for new incidents.
  void forget() noexcept { begun_ = logged_ = owed_ = lost_ = 0; }

  /// How many are complete: their steps after the alarm, and Before more, are over.
  uint32_t complete() const noexcept {
    uint32_t n = 0;
    while (n < begun_ && incidents_[n].first + incidents_[n].length <= logged_) ++n;
    return n;
  }
  uint32_t lost() const noexcept { return lost_; }

  /// Hands sink(const uint8_t* bytes, size_t size) the bytes of complete incident n, at most 32 a
  /// call. False, and no call, where there is no such incident.
  template <class Sink>
  bool write(uint32_t n, const IncidentOrigin& origin, Sink&& sink) const {
    if (n >= complete()) return false;
    const Incident& incident = incidents_[n];
    detail::IncidentWriter<Sink> out(sink);
    for (const uint8_t byte : kIncidentMagic) out.byte(byte);
    out.word(kIncidentVersion);
    out.word(file_bytes(incident.length));
    out.long_word(origin.spec);
    out.long_word(origin.data);
    out.long_word(origin.thresholds);
    out.long_word(origin.columns);
    const uint32_t figures[] = {Row::kWords,       Row::kBytes, Before, After,
                                incident.episode,  n,           lost_,  incident.length,
                                incident.alarm_at, 0,           0,      0};
    for (const uint32_t figure : figures) out.word(figure);
    for (uint32_t i = 0; i < incident.length; ++i) {
      const Row& row = log_[incident.first + i];
      for (const uint32_t word : row.words) out.word(word);
      for (const uint8_t byte : row.bytes) out.byte(byte);
    }
    out.finish();
    return true;
  }

 private:
  struct Incident {
    uint32_t first;     ///< row in the log
    uint32_t length;    ///< in rows
    uint32_t alarm_at;  ///< row of the alarm, counted from the first
    uint32_t episode;
  };

  static constexpr uint32_t file_bytes(uint32_t rows) noexcept {
    const uint32_t bytes = kIncidentHeadBytes + rows * static_cast<uint32_t>(sizeof(Row));
    return (bytes + 31) / 32 * 32 + kIncidentChecksumBytes;
  }

  uint32_t in_ring(uint32_t i) const noexcept {
    const uint32_t at = oldest_ + i;
    return at < kRing ? at : at - kRing;
  }

  /// The oldest row makes room, and goes to the log where an incident holds it.
  void take_oldest() noexcept {
    if (owed_ > 0) {
      log_[logged_++] = ring_[oldest_];
      --owed_;
    }
    oldest_ = in_ring(1);
    --count_;
  }

  /// At the newest row: all rows of the ring, and After to come, go to the log.
  void begin_incident() noexcept {
    if (begun_ == Incidents) {
      if (lost_ != UINT32_MAX) ++lost_;
      return;
    }
    incidents_[begun_++] = {logged_, count_ + After, count_ - 1, episode_};
    owed_ = count_ + After;
  }

  uint32_t oldest_ = 0;   ///< in the ring
  uint32_t count_ = 0;    ///< rows in the ring
  uint32_t owed_ = 0;     ///< rows from the oldest on, those to come included, that go to the log
  uint32_t logged_ = 0;   ///< rows in the log
  uint32_t begun_ = 0;    ///< incidents
  uint32_t lost_ = 0;     ///< alarms without one; saturates
  uint32_t step_ = 0;     ///< of the episode; saturates
  uint32_t episode_ = 0;  ///< saturates
  uint32_t alarms_[kAlarmWords];
  Incident incidents_[Incidents];
  Row ring_[kRing];
  Row log_[kLog];
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
