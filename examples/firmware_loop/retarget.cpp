// Changes parameters on the board: `dock` with --retargetable. The parameters of dock.etl and of
// dock_moved.etl are in flash. The second set is on trial beside the first, and then promoted; a
// damaged page is refused. Writes each verdict, the counts of the trial, and the reasons for
// refusals. The lines are the same on all platforms.
#include <stdint.h>

#include "board.hpp"
#include "dock_retargetable.hpp"
#include "line.hpp"
#include "recording.hpp"

// A linker script, or the tool that flashes the page, would put them there.
asm(".pushsection .rodata\n"
    ".balign 64\n"
    ".global dock_first\n"
    "dock_first: .incbin \"dock_retargetable.params.bin\"\n"
    ".balign 64\n"
    ".global dock_moved\n"
    "dock_moved: .incbin \"dock_moved.params.bin\"\n"
    ".popsection\n");
extern "C" const uint8_t dock_first[], dock_moved[];

namespace {

using dock_retargetable::Params;
using dock_retargetable::Shadow;

constexpr uint32_t kEpisodes = 10, kSteps = 20;

void run(Shadow& shadow, uint32_t episode) noexcept {
    Recording recording(episode);
    float z[6];
    for (uint32_t step = 0; step < kSteps; ++step) {
        recording.fill(z, 6, 0.25f, 1.0f);
        dock_retargetable::Inputs in;
        if (!recording.once_in(17)) in.z = z;
        if (!recording.once_in(5)) in.called = recording.once_in(3);
        for (const auto& [name, verdict] : named(shadow.step(in))) {
            Line line(name);
            line.verdict(verdict);
            line.write();
        }
    }
}

void write_state(etlmon::ParamsState state) noexcept {
    Line line("parameters");
    line.number(static_cast<uint32_t>(state));
    line.write();
}

/// A page in memory with one flipped bit.
etlmon::ParamsState with_damage(dock_retargetable::Monitor& monitor, uint32_t bit) noexcept {
    alignas(64) static uint8_t page[Params::kSize];
    for (size_t i = 0; i < Params::kSize; ++i) page[i] = dock_moved[i];
    page[bit / 8] = static_cast<uint8_t>(page[bit / 8] ^ (1u << (bit % 8)));
    return monitor.retarget(page, Params::kSize, etlmon::Past::forgotten);
}

}  // namespace

int main() {
    const Params first(dock_first, Params::kSize), moved(dock_moved, Params::kSize);
    static Shadow shadow{dock_retargetable::Monitor(first)};
    for (uint32_t episode = 0; episode < kEpisodes; ++episode) {
        if (episode == 2) write_state(shadow.try_out(moved, etlmon::Past::kept));
        if (episode == 6) {
            for (uint32_t m = 0; m < 2; ++m) {
                Line line("trial");
                line.number(shadow.count_of(m).steps);
                line.number(shadow.count_of(m).status);
                line.number(shadow.count_of(m).alarm);
                line.write();
            }
            shadow.promote();
        }
        run(shadow, episode);
        if (episode == 7)
            for (uint32_t bit = 0; bit < 8 * Params::kSize; bit += 97)
                write_state(with_damage(shadow.active(), bit));
        // The third begins, and the seventh continues, in the middle of an episode.
        if (episode != 1 && episode != 5) shadow.reset();
    }
    return 0;
}
