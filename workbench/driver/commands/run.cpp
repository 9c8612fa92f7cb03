#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/recording.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "execute/evaluator.hpp"
#include "plan/recorder_plan.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"
#include "watch/summary.hpp"

namespace etlc::driver {

namespace {

using etlmon::Verdict;

constexpr std::size_t kBufferBytes = 1U << 16U;
constexpr std::uint64_t kStepsPerReport = 4096;

class Run {
public:
    Run(const source::File& spec, const Compiled& compiled, const Request& request,
        diag::Sink& sink)
        : spec_(spec),
          compiled_(compiled),
          plan_(compiled.plan),
          request_(request),
          sink_(sink),
          monitors_(compiled.plan),
          output_(sink) {
        if (request.run.distances) choose_columns();
    }

    bool execute() {
        if (!check_names({plan_.model}, request_.names, sink_)) return false;
        std::vector<std::string> traces{request_.trace};
        if (is_of_several())
            traces = recordings::find_episodes(request_.data, request_.chosen, sink_);
        if (sink_.has_errors()) return false;
        if (!check_outputs({request_.output, request_.run.html, request_.run.svg},
                           files_read(*plan_.model, spec_, traces), sink_))
            return false;
        if (writes_rows() && !output_.begin(request_.output)) return false;
        print_head();
        for (const std::string& trace : traces)
            if (!run(trace)) return false;
        episodes::warn_of_unmarked(*plan_.model, plan_.inputs, traces, request_.names, sink_);
        return flush() && write_pictures() && output_.commit();
    }

private:
    /// Whether the call is about episodes, whose rows and lines name them.
    bool is_of_several() const { return !request_.data.empty(); }

    bool run(const std::string& trace) {
        trace_ = trace;
        step_ = steps_ = 0;
        is_named_ = !is_of_several();
        summary_.emplace(plan_);
        changes_.emplace(plan_);
        first_cells_ = is_of_several() ? source::csv_cell(trace) + "," : "";
        if (!step_through_trace() || !end_episode()) return false;
        if (!request_.run.summary) return true;
        return print_lines(summary_->text(steps_, monitors_.evaluator()) +
                           watch::text_of_drifts(plan_, monitors_.evaluator()));
    }

    /// A recording is an episode that ended regularly. Says so once where a drift raises its alarm.
    bool end_episode() {
        monitors_.evaluator().end_episode();
        const std::string now = watch::text_of_drifts(plan_, monitors_.evaluator(), true);
        const bool is_new = request_.run.changes && now != drifts_;
        drifts_ = now;
        return !is_new || print_lines(now);
    }

    /// Prints lines about this trace, the first ones below its name.
    bool print_lines(const std::string& lines) {
        const std::string name = is_named_ ? "" : source::visible(trace_) + "\n";
        is_named_ = true;
        return print(source::visible_lines(name + lines), sink_);
    }

    bool fail(const diag::Failure& failure) {
        sink_.report(recordings::in_trace(failure, trace_));
        return false;
    }

    bool writes_rows() const { return !request_.output.empty(); }

    bool write_pictures() {
        const std::string& trace = request_.trace;
        if (!request_.run.html.empty()) {
            const auto page = page_of_trace(spec_, compiled_, trace, request_.names, sink_);
            if (!page || !output_.add(request_.run.html, *page)) return false;
        }
        if (request_.run.svg.empty()) return true;
        const auto picture = report::picture(compiled_, trace, {request_.names, nullptr}, sink_);
        return picture && output_.add(request_.run.svg, *picture);
    }

    /// Chooses the columns of distances; unnamed comparisons of one expression share a column.
    void choose_columns() {
        std::set<std::string> seen;
        for (const check::Index p : plan_.predicates)
            if (const std::string name = plan::column_name(*plan_.model, p);
                seen.insert(name).second)
                distances_.emplace_back(name, p);
    }

    void print_head() {
        text_ = is_of_several() ? "trace," : "";
        text_ += "step,monitor,lower,robustness,upper,status,final,position";
        if (plan_.model->step_seconds > 0) text_ += ",time";
        for (const auto& [name, predicate] : distances_)
            text_ += "," + source::csv_cell("distance_" + name);
        for (const plan::Let& let : plan_.lets)
            text_ += ",robustness_" + plan_.model->lets[let.index].name;
        text_ += "\n";
    }

    bool step_through_trace() {
        auto recording = episodes::Recording::open({plan_.model, plan_.inputs}, trace_,
                                                   {request_.names, nullptr});
        if (!recording) return fail(recording.failure());
        episodes::AfterStep rest;
        if (request_.run.finish) rest = [&] { return report(); };
        const auto frame = [&] {
            show_progress(recording->length());
            ++steps_;
            return report();
        };
        const auto done = episodes::replay(*recording, {&monitors_}, frame, rest);
        if (!done) return fail(done.failure());
        if (*done) warn_of_absent_inputs();
        return *done;
    }

    void warn_of_absent_inputs() {
        for (const check::Index input : plan_.inputs) {
            const execute::SampleCounts& counts = monitors_.evaluator().sample_counts()[input];
            if (counts.missing + counts.out_of_range < steps_) continue;
            const char* why = counts.missing == steps_        ? "missing"
                              : counts.out_of_range == steps_ ? "out of its range"
                                                              : "missing or out of its range";
            sink_
                .report(data::in_file(
                    {diag::Code::no_sample, fmt::format("every sample of '{}' is {}",
                                                        plan_.model->inputs[input].name, why)},
                    trace_))
                .note("predicates that measure it are unknown at every step");
        }
    }

    bool report() {
        const std::vector<Verdict>& verdicts = monitors_.verdicts();
        const std::string telemetry = distance_cells() + let_cells();
        for (std::size_t m = 0; m < verdicts.size(); ++m) {
            if (monitors_.reports(plan_.monitors[m].index)) summary_->add(m, step_, verdicts[m]);
            if (writes_rows()) print_row(m, verdicts[m], telemetry);
        }
        if (request_.run.changes && !print_changes()) return false;
        ++step_;
        // A program that pipes a trace waits for each verdict.
        const bool waits = request_.trace == recordings::kStandardInput;
        return (text_.size() < kBufferBytes && !waits) || flush();
    }

    bool print_changes() {
        const auto& verdicts = monitors_.verdicts();
        const std::string lines =
            step_ < steps_ ? changes_->after(step_, verdicts, monitors_.evaluator())
                           : changes_->after_finish(step_, verdicts, monitors_.evaluator());
        return lines.empty() || print_lines(lines);
    }

    void print_row(std::size_t m, const Verdict& v, const std::string& telemetry) {
        const std::string& name = plan_.monitors[m].name;
        const auto out = std::back_inserter(text_);
        text_ += first_cells_;
        if (v.decided())
            fmt::format_to(out, "{},{},{:.9g},{:.9g},{:.9g},{},{},{}", step_, name, v.lower,
                           v.robustness, v.upper, watch::status(v), v.final() ? 1 : 0,
                           monitors_.evaluator().position(m));
        else
            fmt::format_to(out, "{},{},,,,undecided,0,", step_, name);
        if (plan_.model->step_seconds > 0)
            fmt::format_to(out, ",{:.9g}", static_cast<double>(step_) * plan_.model->step_seconds);
        text_ += telemetry;
        text_ += "\n";
    }

    /// Returns the distances at this step; empty after the trace, and where a sample is missing.
    std::string distance_cells() const {
        std::string cells;
        for (const auto& [name, predicate] : distances_) {
            const float distance = monitors_.evaluator().distance(predicate);
            const bool is_known = step_ < steps_ && !std::isnan(distance);
            cells += is_known ? fmt::format(",{:.9g}", distance) : ",";
        }
        return cells;
    }

    /// Returns the robustness of lets at this step; empty after the trace, and where it is unknown.
    std::string let_cells() const {
        std::string cells;
        for (const Verdict& let : monitors_.evaluator().lets()) {
            const bool is_known = step_ < steps_ && !let.unknown();
            cells += is_known ? fmt::format(",{:.9g}", let.robustness) : ",";
        }
        return cells;
    }

    bool flush() {
        const bool written = !writes_rows() || output_.write(text_);
        text_.clear();
        return written;
    }

    void show_progress(std::uint64_t length) const {
        if (!watched_ || length == 0 || step_ % kStepsPerReport != 0) return;
        print_error(fmt::format("\r{:3}% of {} steps", 100 * step_ / length, length));
        if (step_ + kStepsPerReport > length) print_error(kEraseProgress);
    }

    const source::File& spec_;
    const Compiled& compiled_;
    const plan::Plan& plan_;
    const Request& request_;
    diag::Sink& sink_;
    episodes::Follower monitors_;
    std::string trace_;  ///< this one
    std::optional<watch::Summary> summary_;
    std::optional<watch::Changes> changes_;
    std::string drifts_;       ///< lines of those that have raised their alarm
    bool is_named_ = true;     ///< lines about it need no name above them any more
    std::string first_cells_;  ///< of each row
    OutputFiles output_;
    /// The name of each column of distances, and a predicate that has this distance.
    std::vector<std::pair<std::string, check::Index>> distances_;
    std::string text_;
    std::uint64_t step_ = 0;   ///< steps so far, including those after the trace
    std::uint64_t steps_ = 0;  ///< frames so far
    const bool watched_ = progress_is_seen();
};

}  // namespace

bool run(const source::File& spec, const Compiled& compiled, const Request& request,
         diag::Sink& sink) {
    return Run(spec, compiled, request, sink).execute();
}

}  // namespace etlc::driver
