// Reads a flight recorder after two episodes.
// Takes: a request of harness.hpp. Gives, in place of its answer: the numbers of complete and lost
// incidents after each trace, finished and reset, then the size and bytes of each incident.
// Incidents from before the request are forgotten.
#pragma once

#include "harness.hpp"

namespace harness {

template <class Spec>
class Incidents {
 public:
  static void answer() {
    static typename Spec::Monitor monitor;
    Spec::restart(monitor);  // adaptive thresholds keep the values of the previous request
    monitor.forget_incidents();
    const uint32_t calls = read<uint32_t>();
    for (int trace = 0; trace < 2; ++trace) {
      const uint32_t steps = read<uint32_t>();
      read<uint32_t>();  // bytes
      for (uint32_t n = 0; n < steps; ++n) step(monitor, n);
      for (uint32_t n = 0; n < calls; ++n) Spec::finish(monitor);
      monitor.reset();
      write(monitor.incidents());
      write(monitor.lost_incidents());
    }
    for (uint32_t n = 0; n < monitor.incidents(); ++n) give(monitor, n);
  }

 private:
  static void step(typename Spec::Monitor& monitor, uint32_t n) {
    typename Spec::Inputs inputs{};
    typename Spec::Buffers buffers{};
    Spec::labels(monitor);
    Spec::feed(inputs, buffers);
    Spec::restart_before(monitor, n);
    monitor.step(inputs);
  }

  static void give(const typename Spec::Monitor& monitor, uint32_t n) {
    static uint8_t bytes[Spec::Monitor::kIncidentBytes];
    uint32_t size = 0;
    monitor.write_incident(n, [&](const uint8_t* some, size_t count) {
      memcpy(bytes + size, some, count);
      size += static_cast<uint32_t>(count);
    });
    write(size);
    write_bytes(bytes, size);
  }
};

}  // namespace harness
