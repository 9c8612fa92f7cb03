// SPDX-License-Identifier: MIT
// Stands in for a part of the runtime's recorder.hpp when `etlc prove` compiles a class: nothing is
// recorded, since no verdict depends on it.
#pragma once

#define Recorder RecorderOfRuntime
#include_next "etlmon/temporal/recorder.hpp"
#undef Recorder

namespace etlmon {
inline namespace ETLMON_BUILD {

template <class Row, uint32_t Before, uint32_t After, uint32_t Incidents>
struct Recorder : RecorderOfRuntime<Row, Before, After, Incidents> {
    template <class Statuses>
    void record(const Row&, const Statuses&) noexcept {}
};

}  // namespace ETLMON_BUILD
}  // namespace etlmon
