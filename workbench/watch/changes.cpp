#include "watch/changes.hpp"

#include <fmt/format.h>

#include "diag/diag.hpp"
#include "watch/summary.hpp"

namespace etlc::watch {

Changes::Changes(const plan::Plan& plan)
    : plan_(plan), said_(plan.monitors.size(), "undecided"), inputs_(plan.inputs.size()) {}

std::string Changes::after(std::uint64_t step, const std::vector<etlmon::Verdict>& verdicts,
                           const execute::Evaluator& evaluator) {
    std::string text;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
        text += of_input(static_cast<check::Index>(i), step,
                         evaluator.sample_counts()[plan_.inputs[i]]);
    for (std::size_t m = 0; m < said_.size(); ++m)
        text += of_monitor(m, step, verdicts[m], evaluator);
    return text;
}

std::string Changes::after_finish(std::uint64_t step, const std::vector<etlmon::Verdict>& verdicts,
                                  const execute::Evaluator& evaluator) {
    std::string text;
    for (std::size_t m = 0; m < said_.size(); ++m)
        if (plan_.monitors[m].sliding) text += of_monitor(m, step, verdicts[m], evaluator);
    return text;
}

std::string Changes::of_monitor(std::size_t m, std::uint64_t step, const etlmon::Verdict& verdict,
                                const execute::Evaluator& evaluator) {
    const plan::Monitor& monitor = plan_.monitors[m];
    std::string words = status(verdict);
    if (!monitor.sliding && verdict.decided()) words += verdict.final() ? " for good" : " so far";
    // A monitor that begins again has another final verdict each time.
    const bool repeats = monitor.restarts == check::Restarts::when_final && verdict.final();
    if (words == said_[m] && !repeats) return "";
    said_[m] = words;
    // Where a sample is missing, the robustness is only a bound.
    if (verdict.decided() && !verdict.unknown())
        words += fmt::format(", robustness {:.6g}", verdict.robustness);
    if (monitor.sliding && monitor.horizon > 0 && verdict.decided())
        words += fmt::format(", about {}", when(*plan_.model, evaluator.position(m)));
    return fmt::format("{}: {} {}{}\n", when(*plan_.model, step), monitor.name, words,
                       verdict.alarm() ? ": alarm" : "");
}

std::string Changes::of_input(check::Index input, std::uint64_t step,
                              const execute::SampleCounts& counts) {
    OfInput& known = inputs_[input];
    const char* const why = counts.missing > known.counts.missing             ? "is missing"
                            : counts.out_of_range > known.counts.out_of_range ? "is out of range"
                            : counts.stale > known.counts.stale               ? "is stale"
                                                                              : nullptr;
    known.counts = counts;
    const std::string& name = plan_.model->inputs[plan_.inputs[input]].name;
    if (why != nullptr) {
        if (known.absent++ > 0) return "";
        return fmt::format("{}: input {} {}\n", when(*plan_.model, step), name, why);
    }
    if (known.absent == 0) return "";
    return fmt::format("{}: input {} is there again, after {}\n", when(*plan_.model, step), name,
                       diag::counted(std::exchange(known.absent, 0), "step"));
}

}  // namespace etlc::watch
