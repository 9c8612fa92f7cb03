// What the monitors said in a whole trace: a line for each monitor, and for inputs that lacked
// samples.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "etlmon/temporal/verdict.hpp"
#include "execute/evaluator.hpp"
#include "plan/program/program.hpp"

namespace etlc::watch {

/// Returns "satisfied", "violated", "unknown" or "undecided".
const char* status(const etlmon::Verdict& verdict);
/// Returns the status of a prefix: "violated for good", "satisfied so far", "not yet satisfied".
std::string standing(const etlmon::Verdict& verdict);

/// Returns "step 5 (1.25 s)".
std::string when(const check::Model& model, std::uint64_t step);

/// Returns a line for each drift: what it knows after the episodes so far. `alarms`: only those
/// that have raised their alarm.
std::string text_of_drifts(const plan::Plan& plan, const execute::Evaluator& evaluator,
                           bool alarms = false);

/// The figures of `etlc run --summary`, and the last lines of `etlc watch`, in constant memory.
class Summary {
public:
    explicit Summary(const plan::Plan& plan) : plan_(plan), monitors_(plan.monitors.size()) {}

    /// Adds a verdict about a new position of the monitor.
    void add(std::size_t monitor, std::uint64_t step, const etlmon::Verdict& verdict);

    std::string text(std::uint64_t steps, const execute::Evaluator& evaluator) const;

private:
    /// A robustness and its step.
    struct At {
        std::uint64_t step = 0;
        float robustness = 0;
    };
    struct OfMonitor {
        std::uint64_t decided = 0;
        std::uint64_t violated = 0;
        std::uint64_t unknown = 0;
        std::optional<std::uint64_t> first_violated;
        std::optional<At> worst;  ///< least known robustness
        std::optional<std::uint64_t> final_since;
        std::uint64_t alarms = 0;
        std::uint64_t fulfilled = 0;
        std::uint64_t ended_unknown = 0;  ///< cycles whose last verdict is unknown
        std::optional<std::uint64_t> first_alarm;
        etlmon::Verdict last;
    };
    std::string of_prefix(const OfMonitor& monitor) const;
    std::string of_repeating(const OfMonitor& monitor) const;
    std::string of_sliding(const OfMonitor& monitor, std::uint64_t horizon) const;
    std::string of_input(check::Index input, const execute::SampleCounts& counts) const;

    const plan::Plan& plan_;
    std::vector<OfMonitor> monitors_;
};

// A line for everything that changes in what the monitors say, for `etlc watch` and `etlc run
// --changes`: the status of a monitor, an alarm, an input whose samples stop or come back.
// Keeps true: a step at which nothing changes has no line; each change has one.

class Changes {
public:
    explicit Changes(const plan::Plan& plan);

    /// Returns the lines of a step; call it after Evaluator::step().
    std::string after(std::uint64_t step, const std::vector<etlmon::Verdict>& verdicts,
                      const execute::Evaluator& evaluator);
    /// Returns the lines of a position after the trace; call it after Evaluator::finish().
    std::string after_finish(std::uint64_t step, const std::vector<etlmon::Verdict>& verdicts,
                             const execute::Evaluator& evaluator);

private:
    struct OfInput {
        execute::SampleCounts counts;
        std::uint64_t absent = 0;  ///< steps in a row
    };
    std::string of_monitor(std::size_t monitor, std::uint64_t step, const etlmon::Verdict& verdict,
                           const execute::Evaluator& evaluator);
    std::string of_input(check::Index input, std::uint64_t step,
                         const execute::SampleCounts& counts);

    const plan::Plan& plan_;
    std::vector<std::string> said_;  ///< per monitor: the words of its last line
    std::vector<OfInput> inputs_;    ///< per input of the plan
};

}  // namespace etlc::watch
