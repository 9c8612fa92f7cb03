// Two ways to share a monitor, or its input, with an interrupt that comes at any instruction of a
// step. Writes a line for each: the number of steps, the number of interrupts while the monitor was
// at work, and the number of steps in which a verdict differed from the same monitor without
// interrupts. docs/firmware.md explains both.
#include <stdint.h>

#include "board.hpp"
#include "dock.hpp"
#include "grasp.hpp"
#include "line.hpp"
#include "recording.hpp"

namespace {

constexpr uint32_t kSteps = 2000;

volatile bool at_work = false;  // the monitor is in the middle of a call
volatile uint32_t interruptions = 0;

/// Marks a call of the monitor, for its own lifetime.
struct AtWork {
    AtWork() noexcept {
        at_work = true;
        __atomic_signal_fence(__ATOMIC_SEQ_CST);
    }
    ~AtWork() noexcept {
        __atomic_signal_fence(__ATOMIC_SEQ_CST);
        at_work = false;
    }
};
void count_interruption() noexcept {
    if (at_work) interruptions = interruptions + 1;
}

template <class Verdicts>
bool equal(const Verdicts& a, const Verdicts& b) noexcept {
    return __builtin_memcmp(&a, &b, sizeof a) == 0;
}

void report(const char* name, uint32_t different) noexcept {
    Line line(name);
    line.number(kSteps);
    line.number(interruptions);
    line.number(different);
    line.write();
}

/// The loop measures, the interrupt judges: a verdict is at most two steps late.
struct Halves {
    grasp::Monitor monitor;
    grasp::Monitor::Atoms atoms[2];
    grasp::Verdicts verdicts[2];
    volatile uint32_t measured = 0, judged = 0;  // steps; only one side writes each
};
Halves* halves;

void judge() noexcept {
    count_interruption();
    const uint32_t step = halves->judged;
    if (step == halves->measured) return;
    halves->verdicts[step % 2] = halves->monitor.judge(halves->atoms[step % 2]);
    __atomic_signal_fence(__ATOMIC_RELEASE);
    halves->judged = step + 1;
}

void run_halves() noexcept {
    static Halves shared;
    static grasp::Monitor plain;
    grasp::Verdicts expected[2];
    static float embedding[384];
    halves = &shared;
    uint32_t different = 0;
    Recording recording(1);
    board_start_interrupts(judge);
    for (uint32_t step = 0; step < kSteps + 2; ++step) {
        const uint32_t slot = step % 2;
        if (step >= 2) {
            while (shared.judged < step - 1) continue;
            __atomic_signal_fence(__ATOMIC_ACQUIRE);
            different += !equal(shared.verdicts[slot], expected[slot]);
        }
        if (step >= kSteps) continue;
        grasp::Inputs in;
        recording.fill(embedding, 384, 0.0f, 1.0f);
        if (!recording.once_in(17)) in.z = embedding;
        in.force = 2.0f + 2.25f * recording.noise();
        expected[slot] = plain.step(in);
        {
            const AtWork now;
            shared.atoms[slot] = shared.monitor.measure(in);
        }
        __atomic_signal_fence(__ATOMIC_RELEASE);
        shared.measured = step + 1;
    }
    report("halves", different);
}

/// The interrupt fills a buffer, the loop steps with the newest one: it may skip buffers, but
/// always reads a complete one.
constexpr uint8_t kNone = 3;
float frames[3][6];
uint32_t number[3];  // the number of each frame, to make it again for the comparison
volatile uint8_t newest, reading;
volatile uint32_t produced;

void fill(uint32_t frame, float* z) noexcept {
    Recording(frame).fill(z, 6, 0.25f, 1.0f);
}

void produce() noexcept {
    count_interruption();
    uint8_t free = 0;
    while (free == newest || free == reading) ++free;
    fill(produced, frames[free]);
    number[free] = produced;
    produced = produced + 1;
    newest = free;
}

void run_buffered() noexcept {
    static dock::Monitor monitor, plain;
    newest = reading = kNone;
    interruptions = 0;
    uint32_t different = 0;
    board_start_interrupts(produce);
    for (uint32_t steps = 0; steps < kSteps;) {
        {
            const BoardInterruptsOff off;
            reading = newest;
            newest = kNone;
        }
        if (reading == kNone) continue;
        dock::Inputs in;
        in.called = steps % 3 == 0;
        in.z = frames[reading];
        dock::Verdicts verdicts;
        {
            const AtWork now;
            verdicts = monitor.step(in);
        }
        float same[6];
        fill(number[reading], same);
        in.z = same;
        different += !equal(verdicts, plain.step(in));
        reading = kNone;
        ++steps;
    }
    report("buffered", different);
}

}  // namespace

int main() {
    run_halves();
    run_buffered();
    return 0;
}
