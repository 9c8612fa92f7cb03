// A monitor with --explain: `dock`. After each step, for each monitor, it writes the sample that
// decides the verdict: the predicate's name, its step, its distance and threshold as the bits of
// the floats, and the row of the nearest target. The lines are the same on all platforms.
#include <stdint.h>

#include "board.hpp"
#include "dock_why.hpp"
#include "line.hpp"
#include "recording.hpp"

namespace {

constexpr uint32_t kEpisodes = 8, kSteps = 20;

void write(const etlmon::Sample& why) noexcept {
    Line line(why ? why.predicate : "none");
    if (why) {
        line.number(why.step);
        line.figure(why.distance);
        line.figure(why.threshold);
        line.number(why.row);
    }
    line.write();
}

}  // namespace

int main() {
    static dock_why::Monitor monitor;
    float z[6];
    for (uint32_t episode = 0; episode < kEpisodes; ++episode) {
        Recording recording(episode);
        for (uint32_t step = 0; step < kSteps; ++step) {
            recording.fill(z, 6, 0.25f, 1.0f);
            dock_why::Inputs in;
            if (!recording.once_in(17)) in.z = z;
            if (!recording.once_in(5)) in.called = recording.once_in(3);
            monitor.step(in);
            write(monitor.why_docks());
            write(monitor.why_steady());
        }
        monitor.reset();
    }
    return 0;
}
