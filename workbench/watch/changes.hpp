// A line for everything that changes in what the monitors say, for `etlc watch` and `etlc run
// --changes`: the status of a monitor, an alarm, an input whose samples stop or come back.
// Keeps true: a step at which nothing changes has no line; each change has one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "etlmon/temporal/verdict.hpp"
#include "execute/evaluator.hpp"
#include "plan/program/program.hpp"

namespace etlc::watch {

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
