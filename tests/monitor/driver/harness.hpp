// Steps generated monitors on traces from standard input and writes their verdicts to standard
// output. Takes: a sequence of requests (see below), binary, in this machine's byte order. Gives:
// the runs. Keeps true: it is C++17 without exceptions, RTTI or library containers, so it compiles
// like firmware; it compares no floats.
//
// Request: u32 spec, u32 finish calls, then two traces, each u32 steps, u32 bytes and, per step,
// its labels (per adaptive predicate u8 number, then distances and u8 truths) and its samples (per
// input u8 present and, if present, the elements). Answer: the first trace, the second, and the
// second once more. The first two alternate on two instances of the class; the third runs on the
// first instance after reset(). After the last request: u64, the number of allocations during
// construction, steps, finish and reset.
#pragma once

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/samples.hpp"
#include "restarts_before.hpp"

namespace harness {

extern bool watching;         // whether allocations come from a monitor
extern uint64_t allocations;  // the number of allocations
extern bool misbehave;        // allocate while watched: shows that the counting works

void allocate_once();

struct Watch {
  Watch() {
    watching = true;
    if (misbehave) allocate_once();
  }
  ~Watch() { watching = false; }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
};

/// Reads `size` bytes; a truncated request ends the program with status 3.
void read_bytes(void* to, size_t size);
void write_bytes(const void* from, size_t size);

template <class T>
T read() {
  T value;
  read_bytes(&value, sizeof value);
  return value;
}

template <class T>
void write(T value) {
  write_bytes(&value, sizeof value);
}

inline void write_verdict(const etlmon::Verdict& verdict) {
  const bool answers[] = {verdict.satisfied(), verdict.violated(), verdict.unknown(),
                          verdict.decided(), verdict.final()};
  uint32_t bits = 0;
  for (uint32_t n = 0; n < 5; ++n) bits |= static_cast<uint32_t>(answers[n]) << n;
  write(bits);
  write(verdict.robustness);
  write(verdict.lower);
  write(verdict.upper);
}

/// The numbers of a verdict without numbers: -inf is false and +inf true.
inline void write_verdict(const etlmon::BooleanVerdict& verdict) {
  etlmon::Verdict numbers;
  numbers.status = verdict.status;
  numbers.robustness = etlmon::float_of(verdict.satisfied() ? etlmon::kTop : etlmon::kBottom);
  numbers.lower =
      etlmon::float_of(verdict.final() && verdict.satisfied() ? etlmon::kTop : etlmon::kBottom);
  numbers.upper =
      etlmon::float_of(verdict.final() && verdict.violated() ? etlmon::kBottom : etlmon::kTop);
  write_verdict(numbers);
}

/// For a class with --explain: whether there is a sample, then its name and the rest.
inline void write_why(const etlmon::Sample& sample) {
  const bool exists = static_cast<bool>(sample);
  write(static_cast<uint8_t>(exists));
  if (!exists) return;
  const auto length = static_cast<uint32_t>(strlen(sample.predicate));
  write(length);
  write_bytes(sample.predicate, length);
  write(sample.step);
  write(sample.robustness);
  write(sample.distance);
  write(sample.threshold);
  write(sample.row);
}

// If the class lacks an input or predicate, because no monitor depends on it, the overloads for
// `long` are chosen. The macros below instantiate each for the members of one spec.
#define HARNESS_INPUT(name)                                                             \
  struct name##_input {                                                                 \
    template <class Inputs, class Value>                                                \
    static auto set(Inputs& in, const Value& value, int) -> decltype((void)(in.name)) { \
      in.name = value;                                                                  \
    }                                                                                   \
    template <class Inputs, class Value>                                                \
    static void set(Inputs&, const Value&, long) {}                                     \
  }
#define HARNESS_PREDICATE(name) \
  struct name##_predicate {     \
    HARNESS_TELEMETRY(name)     \
  }
#define HARNESS_TELEMETRY(name)                             \
  template <class Monitor>                                  \
  static auto distance(const Monitor& m, float& delta, int) \
      ->decltype((void)m.distance_##name(), true) {         \
    delta = m.distance_##name();                            \
    return true;                                            \
  }                                                         \
  template <class Monitor>                                  \
  static bool distance(const Monitor&, float&, long) {      \
    return false;                                           \
  }                                                         \
  template <class Monitor>                                  \
  static auto nearest(const Monitor& m, uint32_t& row, int) \
      ->decltype((void)m.nearest_##name(), true) {          \
    row = m.nearest_##name();                               \
    return true;                                            \
  }                                                         \
  template <class Monitor>                                  \
  static bool nearest(const Monitor&, uint32_t&, long) {    \
    return false;                                           \
  }
#define HARNESS_ADAPTIVE_PREDICATE(name)                                             \
  struct name##_predicate {                                                          \
    HARNESS_TELEMETRY(name)                                                          \
    template <class Monitor>                                                         \
    static auto observe(Monitor& m, const float& distance, bool truth, int)          \
        -> decltype(m.observe_##name(distance, truth)) {                             \
      m.observe_##name(distance, truth);                                             \
    }                                                                                \
    template <class Monitor>                                                         \
    static void observe(Monitor&, const float&, bool, long) {}                       \
    template <class Monitor>                                                         \
    static auto threshold(const Monitor& m, int) -> decltype(m.threshold_##name()) { \
      return m.threshold_##name();                                                   \
    }                                                                                \
    template <class Monitor>                                                         \
    static float threshold(const Monitor&, long) {                                   \
      return 0.0f;                                                                   \
    }                                                                                \
    template <class Monitor>                                                         \
    static auto restart(Monitor& m, int)                                             \
        -> decltype(m.set_threshold_##name(m.initial_threshold_##name())) {          \
      m.set_threshold_##name(m.initial_threshold_##name());                          \
    }                                                                                \
    template <class Monitor>                                                         \
    static void restart(Monitor&, long) {}                                           \
  }

/// Reads one sample into `element` or `elements`, which a view may keep pointing to; leaves a
/// missing input unset.
template <class Member, class Inputs, class T>
void feed_scalar(Inputs& in, T (&element)[1]) {
  if (read<uint8_t>() == 0) return;
  read_bytes(element, sizeof element);
  Member::set(in, element[0], 0);
}

template <class Member, class Inputs>
void feed_flag(Inputs& in) {
  if (read<uint8_t>() == 0) return;
  const bool on = read<uint8_t>() != 0;
  Member::set(in, on, 0);
}

template <class Member, class Inputs, class T, size_t D>
void feed_vector(Inputs& in, T (&elements)[D]) {
  if (read<uint8_t>() == 0) return;
  read_bytes(elements, sizeof elements);
  Member::set(in, elements, 0);
}

template <class Predicate, class Monitor>
void write_telemetry(const Monitor& monitor) {
  float delta = 0;
  uint32_t row = 0;
  const bool has_delta = Predicate::distance(monitor, delta, 0);
  const bool has_row = Predicate::nearest(monitor, row, 0);
  write(static_cast<uint32_t>(has_delta) | static_cast<uint32_t>(has_row) << 1);
  write(delta);
  write(row);
}

template <class Predicate, class Monitor>
void write_threshold(const Monitor& monitor) {
  write(Predicate::threshold(monitor, 0));
}

template <class Predicate, class Monitor>
void take_labels(Monitor& monitor) {
  for (uint8_t n = read<uint8_t>(); n > 0; --n) {
    float distance = 0;
    read_bytes(&distance, sizeof distance);
    const bool truth = read<uint8_t>() != 0;
    const Watch watch;
    Predicate::observe(monitor, distance, truth, 0);
  }
}

/// A trace, and the monitor's output for it, kept until it can be written.
constexpr size_t kTraceBytes = size_t{1} << 18;
constexpr size_t kAnswerBytes = size_t{1} << 22;

struct Tape {
  uint8_t* bytes;
  size_t capacity;
  size_t size;
  size_t position;
};

/// If set, read takes from `source` and write appends to `sink`, in place of the standard streams.
extern Tape* source;
extern Tape* sink;

Tape& tape(int number);  // 0, 1: the traces; 2, 3: the answers

/// A generated file defines for each spec: Spec::Monitor, Spec::Inputs, Spec::Buffers,
/// Spec::labels, Spec::restart, Spec::restart_before, Spec::feed, Spec::verdicts, Spec::whys,
/// Spec::telemetry, Spec::finish.
template <class Spec>
class Session {
 public:
  static void answer() {
    const uint32_t calls = read<uint32_t>();
    for (int n = 0; n < 2; ++n) load(tape(n), steps_[n]);
    static typename Spec::Monitor first;
    static typename Spec::Monitor second;
    Spec::restart(first);  // those of earlier requests
    Spec::restart(second);
    reset(first);
    reset(second);
    Tape* answers[] = {&tape(2), &tape(3)};
    for (Tape* answer : answers) answer->size = 0;
    const uint32_t most = steps_[0] < steps_[1] ? steps_[1] : steps_[0];
    for (uint32_t n = 0; n < most; ++n) {
      if (n < steps_[0]) step(first, n, tape(0), *answers[0]);
      if (n < steps_[1]) step(second, n, tape(1), *answers[1]);
    }
    end(first, calls, *answers[0]);
    end(second, calls, *answers[1]);
    for (Tape* answer : answers) write_bytes(answer->bytes, answer->size);

    reset(first);
    tape(1).position = 0;
    answers[0]->size = 0;
    for (uint32_t n = 0; n < steps_[1]; ++n) step(first, n, tape(1), *answers[0]);
    end(first, calls, *answers[0]);
    write_bytes(answers[0]->bytes, answers[0]->size);
  }

 private:
  static uint32_t steps_[2];

  static void load(Tape& trace, uint32_t& steps) {
    steps = read<uint32_t>();
    trace.size = read<uint32_t>();
    trace.position = 0;
    if (trace.size <= trace.capacity) read_bytes(trace.bytes, trace.size);
  }

  static void reset(typename Spec::Monitor& monitor) {
    const Watch watch;
    monitor.reset();
  }

  static void step(typename Spec::Monitor& monitor, uint32_t number, Tape& trace, Tape& answer) {
    typename Spec::Inputs inputs{};
    typename Spec::Buffers buffers{};
    source = &trace;
    Spec::labels(monitor);
    Spec::feed(inputs, buffers);
    source = nullptr;
    typename Spec::Verdicts verdicts{};
    {
      const Watch watch;
      Spec::restart_before(monitor, number);
      verdicts = monitor.step(inputs);
    }
    sink = &answer;
    Spec::verdicts(verdicts);
    Spec::whys(monitor);
    Spec::telemetry(monitor);
    sink = nullptr;
  }

  static void end(typename Spec::Monitor& monitor, uint32_t calls, Tape& answer) {
    sink = &answer;
    write(monitor.missing_steps());
    for (uint32_t n = 0; n < calls; ++n) {
      typename Spec::Verdicts verdicts{};
      {
        const Watch watch;
        verdicts = Spec::finish(monitor);
      }
      Spec::verdicts(verdicts);
    }
    sink = nullptr;
  }
};

template <class Spec>
uint32_t Session<Spec>::steps_[2];

using Answer = void (*)();
/// Answers requests until the input ends; returns the exit status.
int serve(const Answer* specs, size_t count, int argc);

}  // namespace harness
