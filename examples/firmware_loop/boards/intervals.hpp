// The intervals between a board's timer interrupts: 1 to 64 ticks, always the same sequence.
#pragma once

#include <stdint.h>

struct Intervals {
    uint32_t state = 0;
    uint32_t next() noexcept {
        state = state * 1664525u + 1013904223u;
        return (state >> 26) + 1;
    }
};
