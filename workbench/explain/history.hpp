// What a monitor said at every step of a trace, and which of it is worth explaining.
// Takes: its verdicts, a step after the other. Gives: the step to explain where nobody chose one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "etlmon/temporal/verdict.hpp"

namespace etlc::explain {

struct History {
    std::vector<etlmon::Verdict> verdicts;
    std::vector<std::uint64_t> positions;  ///< what they are about
    std::optional<std::uint64_t> first_alarm;
    std::optional<std::uint64_t> first_final;

    void add(const etlmon::Verdict& verdict, std::uint64_t position) {
        if (verdict.alarm() && !first_alarm) first_alarm = verdicts.size();
        if (verdict.final() && !first_final) first_final = verdicts.size();
        add_after_trace(verdict, position);
    }
    void add_after_trace(const etlmon::Verdict& verdict, std::uint64_t position) {
        verdicts.push_back(verdict);
        positions.push_back(position);
    }

    /// The first alarm; else the first final verdict, of a prefix monitor; else that of the last
    /// frame.
    std::uint64_t usual_step(bool sliding, std::uint64_t last_frame) const {
        if (first_alarm) return *first_alarm;
        return first_final && !sliding ? *first_final : last_frame;
    }
};

}  // namespace etlc::explain
