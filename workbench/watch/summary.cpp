#include "watch/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "diag/diag.hpp"

namespace etlc::watch {

const char* status(const etlmon::Verdict& verdict) {
    if (!verdict.decided()) return "undecided";
    return verdict.satisfied() ? "satisfied" : verdict.violated() ? "violated" : "unknown";
}

std::string standing(const etlmon::Verdict& verdict) {
    if (!verdict.decided()) return status(verdict);
    if (verdict.final()) return std::string(status(verdict)) + " for good";
    return verdict.violated() ? "not yet satisfied" : std::string(status(verdict)) + " so far";
}

std::string when(const check::Model& model, std::uint64_t step) {
    const double length = model.step_seconds;
    if (length == 0) return fmt::format("step {}", step);
    return fmt::format("step {} ({:.6g} s)", step, static_cast<double>(step) * length);
}

void Summary::add(std::size_t monitor, std::uint64_t step, const etlmon::Verdict& verdict) {
    if (!verdict.decided()) return;
    OfMonitor& m = monitors_[monitor];
    const At here{step, verdict.robustness};
    ++m.decided;
    if (verdict.unknown()) ++m.unknown;
    if (verdict.violated()) {
        ++m.violated;
        if (!m.first_violated) m.first_violated = step;
    }
    const bool known = !verdict.unknown();  // the robustness of an unknown verdict is only a bound
    if (known && (!m.worst || here.robustness < m.worst->robustness)) m.worst = here;
    if (!verdict.final())
        m.final_since.reset();
    else if (!m.final_since)
        m.final_since = step;
    if (verdict.fulfilled()) ++m.fulfilled;
    if (verdict.final() && verdict.unknown()) ++m.ended_unknown;
    if (verdict.alarm()) {
        ++m.alarms;
        if (!m.first_alarm) m.first_alarm = step;
    }
    m.last = verdict;
}

std::string Summary::of_prefix(const OfMonitor& m) const {
    std::string text = standing(m.last);
    if (m.final_since) text += fmt::format(" from {} on", when(*plan_.model, *m.final_since));
    return text + fmt::format(", robustness {:.6g}", m.last.robustness);
}

std::string Summary::of_repeating(const OfMonitor& m) const {
    std::string text = diag::counted(m.alarms, "alarm");
    if (m.first_alarm) text += fmt::format(", the first at {}", when(*plan_.model, *m.first_alarm));
    text += fmt::format("; fulfilled {}", diag::counted(m.fulfilled, "time"));
    if (m.ended_unknown > 0)
        text += fmt::format("; unknown {}", diag::counted(m.ended_unknown, "time"));
    return text +
           fmt::format("; at the end {}, robustness {:.6g}", standing(m.last), m.last.robustness);
}

std::string Summary::of_sliding(const OfMonitor& m, std::uint64_t horizon) const {
    if (!m.worst) return "unknown throughout";
    if (!m.first_violated)
        return fmt::format("never violated, least robustness {:.6g} at {}", m.worst->robustness,
                           when(*plan_.model, m.worst->step - horizon));
    return fmt::format("violated at {} of {}, first at {}, least robustness {:.6g} at {}",
                       m.violated, diag::counted(m.decided, "position"),
                       when(*plan_.model, *m.first_violated - horizon), m.worst->robustness,
                       when(*plan_.model, m.worst->step - horizon));
}

std::string Summary::of_input(check::Index input, const execute::SampleCounts& counts) const {
    std::vector<std::string> parts;
    if (counts.missing > 0) parts.push_back(fmt::format("{} missing", counts.missing));
    if (counts.out_of_range > 0)
        parts.push_back(fmt::format("{} out of range", counts.out_of_range));
    if (counts.stale > 0) parts.push_back(fmt::format("{} stale", counts.stale));
    std::string text = fmt::format("{}", fmt::join(parts, ", "));
    if (counts.held > 0) text += fmt::format(", of which {} held", counts.held);
    return fmt::format("input {}: {}\n", plan_.model->inputs[input].name, text);
}

std::string text_of_drifts(const plan::Plan& plan, const execute::Evaluator& evaluator,
                           bool alarms) {
    std::string text;
    for (std::size_t i = 0; i < plan.drifts.size(); ++i) {
        const bool alarm = evaluator.drift(i).alarm(evaluator.drift_cells(i));
        if (alarms && !alarm) continue;
        const etlmon::DriftState& state = evaluator.drift(i).state();
        const check::Drift& drift = plan.model->drifts[plan.drifts[i]];
        text +=
            fmt::format("drift {}: {} after {}, wealth {:.3g} of {:.3g}\n", drift.name,
                        alarm ? "ALARM" : "no alarm", diag::counted(state.episodes(), "episode"),
                        state.wealth(), drift.cells.limit);
    }
    return text;
}

std::string Summary::text(std::uint64_t steps, const execute::Evaluator& evaluator) const {
    std::string text;
    for (std::size_t i = 0; i < monitors_.size(); ++i) {
        const OfMonitor& m = monitors_[i];
        const plan::Monitor& monitor = plan_.monitors[i];
        const bool repeats = monitor.restarts == check::Restarts::when_final;
        const std::string said = m.decided == 0    ? "undecided throughout"
                                 : monitor.sliding ? of_sliding(m, monitor.horizon)
                                 : repeats         ? of_repeating(m)
                                                   : of_prefix(m);
        text += fmt::format("{}: {}", monitor.name, said);
        if (m.unknown > 0) text += fmt::format("; unknown on {}", diag::counted(m.unknown, "step"));
        text += "\n";
    }
    text += fmt::format("{}\n", diag::counted(steps, "step"));
    for (const check::Index input : plan_.inputs) {
        const execute::SampleCounts& counts = evaluator.sample_counts()[input];
        if (counts.missing + counts.out_of_range + counts.stale > 0)
            text += of_input(input, counts);
    }
    return text;
}

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
    std::string words = monitor.sliding ? status(verdict) : standing(verdict);
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
