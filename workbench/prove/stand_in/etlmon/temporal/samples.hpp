// SPDX-License-Identifier: MIT
// Stands in for the runtime's samples.hpp when `etlc prove` compiles a class with --explain. Which
// end of a verdict names its sample is left out; the ends themselves are proved.
#pragma once

#include <stdint.h>

#include "etlmon/scalars.hpp"
#include "etlmon/temporal/sourced.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

constexpr uint32_t kNoRow = 0xffffffffu;

struct Sample {};

struct Place {
    enum class Kind : uint8_t { at_most, at_least, truth };
    const char* name;
    Kind kind;
    float threshold;
    uint32_t first;
    uint32_t rows;
    float inner = kMissing;
};

ETLMON_INLINE uint32_t code_of(uint32_t, const float&, uint32_t = 0, uint32_t = 1) noexcept {
    return 0;
}
ETLMON_INLINE uint32_t code_of(uint32_t, const Flag&) noexcept {
    return 0;
}

template <uint32_t Monitors>
class Deciding {
public:
    constexpr void reset() noexcept {
        for (SourcedKey& key : keys_) key = SourcedKey(kBottom);
    }
    Verdict prefix(uint32_t, const BasicReading<Sourced>& of, bool complete = false) noexcept {
        return prefix_verdict(unsourced(of), complete);
    }
    /// With one shift or two.
    template <class... More>
    Verdict prefix(uint32_t m, const BasicReading<Sourced>& of, const float&,
                   More... more) noexcept {
        return prefix(m, of, more...);
    }
    template <class... Shifts>
    Verdict sliding(uint32_t, Sourced of, const Shifts&...) noexcept {
        return sliding_verdict(unsourced(of));
    }
    Verdict undecided(uint32_t) noexcept { return {}; }
    SourcedKey operator[](uint32_t m) const noexcept { return keys_[m]; }

private:
    SourcedKey keys_[Monitors];
};

template <uint32_t Codes, uint32_t Places>
Sample sample_of(SourcedKey, const Place (&)[Places], int32_t = 0) noexcept {
    return {};
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
