// Counts the instructions of single steps under callgrind, over worst-case signals for windows and
// machines. Takes: a generated class over inputs x and y. Gives: a callgrind dump "NAME OPERATIONS"
// for each measured step, and on standard output the stated and the actual bytes.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <valgrind/callgrind.h>

namespace worst_step {

/// Five signals of 700 steps each: rising, falling, a saw, noise, noise with gaps.
inline float signal(uint32_t step, uint32_t shift) {
  const uint32_t at = step % 700;
  const uint32_t noise = (step + 1 + shift * 977) * 2654435761u;
  switch (step / 700 % 5) {
    case 0:
      return static_cast<float>(at) / 200 - 2;
    case 1:
      return 2 - static_cast<float>(at) / 200;
    case 2:
      return static_cast<float>((at + shift * 7) % 29) / 8 - 2;
    case 3:
      return static_cast<float>(noise >> 24) / 64 - 2;
    default:
      return noise >> 29 == 0 ? etlmon::kMissing : static_cast<float>(noise >> 24) / 64 - 2;
  }
}

/// Every step of the first 3500, and those around the block boundaries of a window of 100 001.
inline bool looked_at(uint32_t step) {
  return step < 3500 ? step % 7 < 2 || (step > 40 && step < 220) : (step + 4) % 50000 < 8;
}

template <class Monitor>
constexpr auto stack_of(int) -> decltype(Monitor::kStackBytes) {
  return Monitor::kStackBytes;
}
template <class Monitor>
constexpr size_t stack_of(long) {
  return 0;
}

template <class Inputs>
auto set_y(Inputs& in, float value, int) -> decltype(in.y, void()) {
  in.y = value;
}
template <class Inputs>
void set_y(Inputs&, float, long) {}  // a class that reads x alone

template <class Monitor, class Inputs>
void run(const char* name, uint32_t steps) {
  static Monitor monitor;
  char label[64];
  snprintf(label, sizeof label, "%s %u", name, Monitor::kOperations);
  printf("%s state %zu taken %zu stack %zu\n", name, Monitor::kStateBytes, sizeof monitor,
         stack_of<Monitor>(0));
  for (uint32_t step = 0; step < steps; ++step) {
    Inputs in;
    in.x = signal(step, 0);
    set_y(in, signal(step, 1), 0);
    if (!looked_at(step)) {
      monitor.step(in);
      continue;
    }
    CALLGRIND_ZERO_STATS;
    monitor.step(in);
    CALLGRIND_DUMP_STATS_AT(label);
  }
}

}  // namespace worst_step
