// SPDX-License-Identifier: MIT
// The flight recorder: inputs and verdicts around each alarm. Takes: a row per step, with the
// status of every verdict. Gives: incidents, each the steps around an alarm, in the format of
// docs/recordings.md. Keeps true: no heap; a step copies its row once, and a row of an incident
// once more, BEFORE steps later; a complete incident does not change until it is removed, so it may
// be written while the monitor steps; the bytes are little-endian and the same on every machine.
#pragma once

#include "etlmon/checksum.hpp"
#include "etlmon/scalars.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

/// In a row: the predicate was not evaluated. A missing sample has kMissingBits.
constexpr uint32_t kUnaskedBits = 0x7fc00001u;
/// Bools in a row: false, true, missing, not evaluated.
constexpr uint8_t kRecordedFalse = 0, kRecordedTrue = 1, kRecordedMissing = 2, kRecordedUnasked = 3;
/// Added to the bits of Answers in a recorded status: an alarm begins at this step.
constexpr uint8_t kAlarmBegins = 16;

/// "\x89ETLINC\n": the first byte is not text, so text conversions are detected.
constexpr uint8_t kIncidentMagic[8] = {0x89, 'E', 'T', 'L', 'I', 'N', 'C', '\n'};
constexpr uint32_t kIncidentVersion = 1;
constexpr uint32_t kIncidentHeadBytes = 96;
constexpr uint32_t kIncidentChecksumBytes = 8;

/// The setters of a row of any size; Self has `words` and `bytes`.
template <class Self>
struct RowCalls {
  /// Records a distance, an expression or a threshold. Every NaN is recorded with the same bits.
  void figure(uint32_t at, const float& x) noexcept {
    self().words[1 + at] = is_nan(x) ? detail::kMissingBits : detail::observe(x);
  }
  /// Records a distance and the row of the nearest target.
  void figures(uint32_t at, const float& delta, uint32_t nearest) noexcept {
    figure(at, delta);
    this->nearest(at + 1, nearest);
  }
  /// Records only that row, after an expression.
  void nearest(uint32_t at, uint32_t row) noexcept { self().words[1 + at] = row; }
  void flag(uint32_t at, const Flag& x) noexcept {
    self().bytes[at] =
        x.present() ? (x.value() ? kRecordedTrue : kRecordedFalse) : kRecordedMissing;
  }

 private:
  Self& self() noexcept { return static_cast<Self&>(*this); }
};

/// The record of a step: its number, a word per figure of a predicate, a byte per bool and per
/// verdict.
template <uint32_t Figures, uint32_t Bools, uint32_t Monitors>
struct RecorderCells {
  static constexpr uint32_t kWords = 1 + Figures;
  static constexpr uint32_t kBytes = Bools + Monitors;
  static constexpr uint32_t kPaddedBytes = (kBytes + 3) / 4 * 4;
  static constexpr uint32_t kBools = Bools;
  static constexpr uint32_t kMonitors = Monitors;

  uint32_t words[kWords];
  uint8_t bytes[kPaddedBytes];
};

/// The row of a step.
template <uint32_t Figures, uint32_t Bools, uint32_t Monitors>
struct RecorderRow : RecorderCells<Figures, Bools, Monitors>,
                     RowCalls<RecorderRow<Figures, Bools, Monitors>> {
  using Cells = RecorderCells<Figures, Bools, Monitors>;

  /// Starts as a step at which nothing was evaluated.
  RecorderRow() noexcept {
    this->words[0] = 0;
    for (uint32_t i = 1; i < Cells::kWords; ++i) this->words[i] = kUnaskedBits;
    for (uint32_t i = 0; i < Cells::kPaddedBytes; ++i)
      this->bytes[i] = i < Bools ? kRecordedUnasked : 0;
  }
};

/// The hashes of the monitor, in the head of an incident.
struct IncidentOrigin {
  uint64_t spec;
  uint64_t data;
  uint64_t thresholds;
  uint64_t columns;  ///< hash of the columns of rows
};

namespace detail {

/// Buffers the output: 32 bytes at a time, as the checksum needs them.
template <class Sink>
class IncidentWriter {
 public:
  explicit IncidentWriter(Sink& etlmon_sink) noexcept : sink_(etlmon_sink) {}

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
  /// Writes zeros up to a multiple of 32, and the checksum of all bytes so far.
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

/// An incident in the log.
struct RecordedIncident {
  uint32_t first;     ///< row in the log
  uint32_t length;    ///< in rows
  uint32_t alarm_at;  ///< row of the alarm, from the first on
  uint32_t episode;
};

/// The storage of a recorder of fixed sizes.
template <class RowOf, uint32_t Before, uint32_t After, uint32_t Incidents>
struct RecorderArrays {
  using Row = RowOf;
  using Statuses = uint32_t[Row::kMonitors];

  static constexpr uint32_t before() noexcept { return Before; }
  static constexpr uint32_t after() noexcept { return After; }
  static constexpr uint32_t most_incidents() noexcept { return Incidents; }
  static constexpr uint32_t bools() noexcept { return Row::kBools; }
  static constexpr uint32_t monitors() noexcept { return Row::kMonitors; }
  static constexpr uint32_t row_words() noexcept { return Row::kWords; }

  uint32_t alarms[(Row::kMonitors + 31) / 32];
  RecordedIncident incidents[Incidents];
  typename Row::Cells ring[Before + 1];
  typename Row::Cells log[Incidents * (Before + 1 + After)];
};

/// A ring of the last `before` steps and this one, and a log of the steps that incidents hold. A
/// row moves from the ring to the log if an incident holds it; overlapping incidents share rows.
/// The first `most_incidents` alarms are kept; later ones are counted as lost, until forget().
template <class Storage>
class RecorderIn {
  using Row = typename Storage::Row;
  static constexpr uint32_t kAlarm = Verdict::kViolated | Verdict::kFinal;

 public:
  constexpr RecorderIn() noexcept { end_episode(); }
  /// Uses storage whose sizes are known at run time.
  explicit RecorderIn(Storage&& etlmon_kept) noexcept : kept_(static_cast<Storage&&>(etlmon_kept)) {
    end_episode();
  }

  /// Records a step. `statuses`: of the verdicts, in the order of the spec. An alarm begins if a
  /// verdict is an alarm, and was none at the step before.
  void record(const Row& row, const typename Storage::Statuses& statuses) noexcept {
    if (count_ == ring_rows()) take_oldest();
    auto& here = kept_.ring[in_ring(count_)];
    ++count_;
    here = row;
    here.words[0] = step_;
    if (step_ != UINT32_MAX) ++step_;
    bool begins = false;
    for (uint32_t m = 0; m < kept_.monitors(); ++m) {
      uint32_t& alarms = kept_.alarms[m / 32];
      const uint32_t bit = uint32_t{1} << (m % 32);
      const bool alarm = (statuses[m] & kAlarm) == kAlarm;
      const bool first = alarm && (alarms & bit) == 0;
      alarms = alarm ? alarms | bit : alarms & ~bit;
      here.bytes[kept_.bools() + m] =
          static_cast<uint8_t>(statuses[m] | (first ? kAlarmBegins : 0u));
      begins = begins || first;
    }
    if (begins) begin_incident();
  }

  /// Monitor m was restarted: its next alarm is a new one.
  constexpr void restart(uint32_t m) noexcept {
    kept_.alarms[m / 32] &= ~(uint32_t{1} << (m % 32));
  }

  /// Starts a new episode, without earlier steps.
  constexpr void end_episode() noexcept {
    close();
    oldest_ = count_ = 0;
    if (step_ != 0 && episode_ != UINT32_MAX) ++episode_;
    step_ = 0;
    for (uint32_t i = 0; i < (kept_.monitors() + 31) / 32; ++i) kept_.alarms[i] = 0;
  }

  /// Completes the incidents that wait for steps, with the steps recorded so far.
  constexpr void close() noexcept {
    for (uint32_t i = 0; i < count_ && owed_ > 0; ++i, --owed_)
      kept_.log[logged_++] = kept_.ring[in_ring(i)];
    owed_ = 0;
    for (uint32_t n = complete(); n < begun_; ++n)
      kept_.incidents[n].length = logged_ - kept_.incidents[n].first;
  }

  /// Removes the incidents, to make room for new ones.
  void forget() noexcept { begun_ = logged_ = owed_ = lost_ = 0; }

  /// Returns the number of complete incidents: BEFORE + AFTER steps after their alarm.
  constexpr uint32_t complete() const noexcept {
    uint32_t n = 0;
    while (n < begun_ && kept_.incidents[n].first + kept_.incidents[n].length <= logged_) ++n;
    return n;
  }
  uint32_t lost() const noexcept { return lost_; }

  /// Calls sink(const uint8_t* bytes, size_t size) for the bytes of complete incident n, at most 32
  /// per call. Returns false, without a call, if there is no such incident.
  template <class Sink>
  bool write(uint32_t n, const IncidentOrigin& origin, Sink&& sink) const {
    if (n >= complete()) return false;
    const RecordedIncident& incident = kept_.incidents[n];
    detail::IncidentWriter<Sink> out(sink);
    for (const uint8_t byte : kIncidentMagic) out.byte(byte);
    out.word(kIncidentVersion);
    out.word(file_bytes(incident.length));
    out.long_word(origin.spec);
    out.long_word(origin.data);
    out.long_word(origin.thresholds);
    out.long_word(origin.columns);
    const uint32_t row_bytes = kept_.bools() + kept_.monitors();
    const uint32_t figures[] = {kept_.row_words(),
                                row_bytes,
                                kept_.before(),
                                kept_.after(),
                                incident.episode,
                                n,
                                lost_,
                                incident.length,
                                incident.alarm_at,
                                0,
                                0,
                                0};
    for (const uint32_t figure : figures) out.word(figure);
    for (uint32_t i = 0; i < incident.length; ++i) {
      const auto& row = kept_.log[incident.first + i];
      for (const uint32_t word : row.words) out.word(word);
      for (const uint8_t byte : row.bytes) out.byte(byte);
    }
    out.finish();
    return true;
  }

 private:
  constexpr uint32_t ring_rows() const noexcept { return kept_.before() + 1; }

  uint32_t file_bytes(uint32_t rows) const noexcept {
    const uint32_t row = 4 * kept_.row_words() + (kept_.bools() + kept_.monitors() + 3) / 4 * 4;
    const uint32_t bytes = kIncidentHeadBytes + rows * row;
    return (bytes + 31) / 32 * 32 + kIncidentChecksumBytes;
  }

  constexpr uint32_t in_ring(uint32_t i) const noexcept {
    const uint32_t at = oldest_ + i;
    return at < ring_rows() ? at : at - ring_rows();
  }

  /// Removes the oldest row, and copies it to the log if an incident holds it.
  void take_oldest() noexcept {
    if (owed_ > 0) {
      kept_.log[logged_++] = kept_.ring[oldest_];
      --owed_;
    }
    oldest_ = in_ring(1);
    --count_;
  }

  /// Begins an incident at the newest row: all rows of the ring and the next `after` go to the log.
  void begin_incident() noexcept {
    if (begun_ == kept_.most_incidents()) {
      if (lost_ != UINT32_MAX) ++lost_;
      return;
    }
    kept_.incidents[begun_++] = {logged_, count_ + kept_.after(), count_ - 1, episode_};
    owed_ = count_ + kept_.after();
  }

  uint32_t oldest_ = 0;   ///< in the ring
  uint32_t count_ = 0;    ///< rows in the ring
  uint32_t owed_ = 0;     ///< rows from the oldest on, including future ones, that go to the log
  uint32_t logged_ = 0;   ///< rows in the log
  uint32_t begun_ = 0;    ///< incidents
  uint32_t lost_ = 0;     ///< alarms without an incident; saturates
  uint32_t step_ = 0;     ///< of the episode; saturates
  uint32_t episode_ = 0;  ///< saturates
  Storage kept_{};
};

template <class Row, uint32_t Before, uint32_t After, uint32_t Incidents>
using Recorder = RecorderIn<RecorderArrays<Row, Before, After, Incidents>>;

}  // namespace ETLMON_BUILD
}  // namespace etlmon
