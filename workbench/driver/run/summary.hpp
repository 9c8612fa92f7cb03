// What a trace came to: `etlc run --summary`.
// Takes: the verdicts of every step. Gives: a line for each monitor, and for each input with
// missing samples. Keeps true: constant memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etlmon/temporal/verdict.hpp"
#include "plan/evaluate/evaluator.hpp"

namespace etlc::driver {

class RunSummary {
public:
    explicit RunSummary(const plan::Plan& plan) : plan_(plan), monitors_(plan.monitors.size()) {}

    /// After each step that has something new to say of that monitor.
    void add(std::size_t monitor, std::uint64_t step, const etlmon::Verdict& verdict);

    std::string text(std::uint64_t steps, const plan::Evaluator& evaluator) const;

private:
    /// A number with the step that it stood at.
    struct At {
        std::uint64_t step = 0;
        float robustness = 0;
    };
    struct OfMonitor {
        std::uint64_t decided = 0;
        std::uint64_t violated = 0;
        std::uint64_t unknown = 0;
        std::optional<std::uint64_t> first_violated;
        std::optional<At> worst;  ///< of those that are known
        std::optional<std::uint64_t> final_since;
        std::uint64_t alarms = 0;
        std::uint64_t fulfilled = 0;
        std::optional<std::uint64_t> first_alarm;
        etlmon::Verdict last;
    };
    std::string of_prefix(const OfMonitor& monitor) const;
    std::string of_repeating(const OfMonitor& monitor) const;
    std::string of_sliding(const OfMonitor& monitor, std::uint64_t horizon) const;
    std::string of_input(check::Index input, const plan::SampleCounts& counts) const;
    std::string when(std::uint64_t step) const;

    const plan::Plan& plan_;
    std::vector<OfMonitor> monitors_;
};

/// "satisfied", "violated", "unknown" or "undecided".
const char* status(const etlmon::Verdict& verdict);

}  // namespace etlc::driver
