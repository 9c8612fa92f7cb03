// Seven monitors in firmware-like loops: no heap, no operating system, reused input buffers. Writes
// a line per step: the monitor class, the step, and for every verdict its status, lower bound,
// robustness and upper bound, as the bits of the floats. The lines are the same on all platforms,
// which tests/firmware checks.
#include <stdint.h>

#include "belt.hpp"
#include "board.hpp"
#include "dock.hpp"
#include "drift.hpp"
#include "gauge.hpp"
#include "grasp.hpp"
#include "hover.hpp"
#include "line.hpp"
#include "recording.hpp"
#include "sort.hpp"

namespace {

constexpr uint32_t kEpisodes = 50, kSteps = 50;

void show(const grasp::Verdicts& v, Line& to) noexcept {
    to.verdict(v.grasped);
}
void show(const dock::Verdicts& v, Line& to) noexcept {
    to.verdict(v.docks), to.verdict(v.steady);
}
void show(const hover::Verdicts& v, Line& to) noexcept {
    to.verdict(v.settles), to.verdict(v.lands), to.verdict(v.kept);
}
void show(const belt::Verdicts& v, Line& to) noexcept {
    to.verdict(v.calm), to.verdict(v.jolted);
}
void show(const gauge::Verdicts& v, Line& to) noexcept {
    to.verdict(v.returns), to.verdict(v.explains);
}
void show(const sort::Verdicts& v, Line& to) noexcept {
    to.verdict(v.sorted), to.verdict(v.found);
}
void show(const drift::Verdicts& v, Line& to) noexcept {
    to.verdict(v.stops), to.verdict(v.slips), to.verdict(v.patient), to.verdict(v.eases);
}

// Like a driver: fills buffers that live as long as the loop, and passes views of them.
float embedding[384];
uint16_t halves[16];
int8_t bytes[16];

void sample(Recording& from, grasp::Inputs& in) noexcept {
    from.fill(embedding, 384, 0.0f, 1.0f);
    if (!from.once_in(17)) in.z = embedding;
    in.force = 2.0f + 2.25f * from.noise();  // sometimes outside its range
}
void sample(Recording& from, dock::Inputs& in) noexcept {
    static float z[6];
    from.fill(z, 6, 0.25f, 1.0f);
    if (!from.once_in(17)) in.z = z;
    if (!from.once_in(5)) in.called = from.once_in(3);
}
void sample(Recording& from, hover::Inputs& in) noexcept {
    in.x = 0.5f + from.noise();
    in.y = 0.125f + from.noise();
    if (!from.once_in(40)) in.battery = 0.75f + 0.75f * from.noise();
}
void sample(Recording& from, belt::Inputs& in) noexcept {
    from.fill(halves, 16);
    from.fill(bytes, 16, 64);
    if (!from.once_in(17)) in.a = halves;
    if (!from.once_in(17)) in.b = bytes;
}
void sample(Recording& from, gauge::Inputs& in) noexcept {
    static float v[3];
    from.fill(v, 3, 0.75f, 1.25f);
    if (!from.once_in(9)) in.v = v;
    in.t = 1.0f + from.noise();
}
void sample(Recording& from, sort::Inputs& in) noexcept {
    static float z[12];
    from.fill(z, 12, 0.25f, 0.75f);
    if (!from.once_in(9)) in.z = z;
}
void sample(Recording& from, drift::Inputs& in) noexcept {
    static uint16_t z[4];
    from.fill(z, 4);
    if (!from.once_in(9)) in.z = z;
    in.force = 2.0f + 2.125f * from.noise();  // sometimes outside its range
}

/// Runs all episodes of one monitor class. Returns the average number of instructions per step.
template <class Monitor, class Inputs>
uint32_t run(const char* name) noexcept {
    static Monitor monitor;
    uint32_t instructions = 0;
    for (uint32_t episode = 0; episode < kEpisodes; ++episode) {
        Recording recording(episode);
        monitor.reset();
        for (uint32_t step = 0; step < kSteps; ++step) {
            Inputs in;
            sample(recording, in);
            const unsigned before = board_instructions();
            const auto verdicts = monitor.step(in);
            instructions += (board_instructions() - before) & 0xffffff;
            Line line(name);
            line.number(episode * kSteps + step);
            show(verdicts, line);
            line.write();
        }
    }
    return instructions / (kEpisodes * kSteps);
}

void report(const char* name, uint32_t instructions) noexcept {
    Line line(name);
    line.number(instructions);
    line.write();
}

}  // namespace

int main() {
    const uint32_t grasps = run<grasp::Monitor, grasp::Inputs>("grasp");
    const uint32_t docks = run<dock::Monitor, dock::Inputs>("dock");
    const uint32_t hovers = run<hover::Monitor, hover::Inputs>("hover");
    const uint32_t belts = run<belt::Monitor, belt::Inputs>("belt");
    const uint32_t gauges = run<gauge::Monitor, gauge::Inputs>("gauge");
    const uint32_t sorts = run<sort::Monitor, sort::Inputs>("sort");
    const uint32_t drifts = run<drift::Monitor, drift::Inputs>("drift");
    report("instructions grasp", grasps);
    report("instructions dock", docks);
    report("instructions hover", hovers);
    report("instructions belt", belts);
    report("instructions gauge", gauges);
    report("instructions sort", sorts);
    report("instructions drift", drifts);
    return 0;
}
