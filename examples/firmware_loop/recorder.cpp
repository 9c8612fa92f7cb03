// A monitor with a flight recorder: steps `dock` until there is no room for another incident. Then
// writes every incident as a driver would write it to flash, here as lines of text: its number, and
// up to 32 bytes in hexadecimal. The bytes are the same on all platforms, and `etlc incident` reads
// them.
#include <stdint.h>

#include "board.hpp"
#include "dock_recorded.hpp"
#include "line.hpp"
#include "recording.hpp"

namespace {

constexpr uint32_t kEpisodes = 8, kSteps = 20;

/// The sink of write_incident(): writes one line per call.
struct Flash {
    uint32_t incident;
    void operator()(const uint8_t* bytes, size_t size) const noexcept {
        Line line("incident");
        line.number(incident);
        line.bytes(bytes, size);
        line.write();
    }
};

}  // namespace

int main() {
    static dock_recorded::Monitor monitor;
    float z[6];
    for (uint32_t episode = 0; episode < kEpisodes; ++episode) {
        Recording recording(episode);
        for (uint32_t step = 0; step < kSteps; ++step) {
            recording.fill(z, 6, 0.25f, 1.0f);
            dock_recorded::Inputs in;
            if (!recording.once_in(17)) in.z = z;
            if (!recording.once_in(5)) in.called = recording.once_in(3);
            monitor.step(in);
        }
        monitor.reset();  // the next episode; incidents stay
    }
    for (uint32_t n = 0; n < monitor.incidents(); ++n) monitor.write_incident(n, Flash{n});
    Line line("lost");
    line.number(monitor.lost_incidents());
    line.write();
    return 0;
}
