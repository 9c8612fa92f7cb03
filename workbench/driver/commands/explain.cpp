#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/recording.hpp"
#include "explain/report.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

using check::Index;
using explain::History;

/// Steps through a trace and explains a verdict of a monitor.
class Explaining {
public:
    Explaining(const Compiled& compiled, const Request& request, diag::Sink& sink)
        : plan_(compiled.plan),
          model_(*compiled.plan.model),
          request_(request),
          sink_(sink),
          observations_(model_, plan_.values, plan_.predicates, plan_.inputs),
          histories_(plan_.monitors.size()) {}

    std::optional<std::string> text() {
        if (!has_monitor() || !has_time() || !step_through_trace()) return std::nullopt;
        const History& history = choose_monitor();
        const auto step = choose_step(history);
        if (!step) return std::nullopt;
        const std::uint64_t last_frame = observations_.steps() - 1;
        const explain::Question question{plan_.monitors[chosen_].index, history.positions[*step],
                                         std::min(*step, last_frame)};
        const explain::Report report =
            explain::report(observations_, ir::lower(model_), question, history.verdicts[*step]);
        return request_.explain.format == ExplanationFormat::json
                   ? explain::json(report)
                   : source::visible_lines(explain::text(report));
    }

private:
    std::nullopt_t refuse(diag::Code code, const std::string& message) {
        sink_.report(data::in_file({code, message}, request_.trace));
        return std::nullopt;
    }

    bool has_monitor() {
        if (request_.explain.monitor.empty()) return true;
        std::vector<std::string> names;
        for (const plan::Monitor& monitor : plan_.monitors) {
            if (monitor.name == request_.explain.monitor) return true;
            names.push_back(monitor.name);
        }
        const std::string meant = data::suggestion(request_.explain.monitor, names);
        sink_.report(data::in_file(
            {diag::Code::no_such_monitor,
             fmt::format(
                 "the spec has no monitor {}{}", data::in_quotes(request_.explain.monitor),
                 meant.empty() ? fmt::format(", it has {}", diag::alternatives(names)) : meant)},
            "--monitor " + request_.explain.monitor));
        return false;
    }

    bool has_time() {
        if (!request_.explain.at || model_.step_seconds > 0) return true;
        sink_
            .report(data::in_file(
                {diag::Code::steps_without_time, "the spec has no rate, so its steps have no time"},
                "--at"))
            .note("give the step with --step, or the spec a rate");
        return false;
    }

    bool step_through_trace() {
        auto recording = episodes::Recording::open({&model_, plan_.inputs}, request_.trace,
                                                   {request_.names, nullptr});
        if (!recording) return fail(recording.failure());
        episodes::Follower monitors(plan_);
        episodes::Follower atoms(observations_.plan());
        const auto frame = [&] {
            observations_.add(atoms.evaluator());
            for (std::size_t m = 0; m < histories_.size(); ++m)
                histories_[m].add(monitors.verdicts()[m], monitors.evaluator().position(m));
            return true;
        };
        // The last positions of sliding monitors, judged with the trace as it ended.
        const auto rest = [&] {
            for (std::size_t m = 0; m < histories_.size(); ++m)
                if (monitors.reports(plan_.monitors[m].index))
                    histories_[m].add_after_trace(monitors.verdicts()[m],
                                                  monitors.evaluator().position(m));
            return true;
        };
        const auto done = episodes::replay(*recording, {&monitors, &atoms}, frame, rest);
        if (!done) return fail(done.failure());
        return observations_.steps() > 0 || fail(recordings::no_steps());
    }

    bool fail(const diag::Failure& failure) {
        sink_.report(recordings::in_trace(failure, request_.trace));
        return false;
    }

    const History& choose_monitor() {
        for (std::size_t m = histories_.size(); m-- > 0;) {
            const bool is_asked_for = request_.explain.monitor.empty()
                                          ? histories_[m].first_alarm.has_value()
                                          : plan_.monitors[m].name == request_.explain.monitor;
            if (is_asked_for) chosen_ = m;
        }
        return histories_[chosen_];
    }

    std::optional<std::uint64_t> choose_step(const History& history) {
        const plan::Monitor& monitor = plan_.monitors[chosen_];
        const std::uint64_t steps = history.verdicts.size();
        std::uint64_t step = history.usual_step(monitor.sliding, observations_.steps() - 1);
        if (request_.explain.step)
            step = *request_.explain.step;
        else if (request_.explain.at)
            step = static_cast<std::uint64_t>(
                std::llround(std::min(*request_.explain.at / model_.step_seconds, 1e18)));
        if (step >= steps) return refuse(diag::Code::no_such_step, beyond(steps));
        if (!history.verdicts[step].decided())
            return refuse(diag::Code::no_such_step,
                          fmt::format("'{}' has no verdict before step {}, found step {}",
                                      monitor.name, monitor.horizon, step));
        return step;
    }

    std::string beyond(std::uint64_t steps) const {
        if (request_.explain.step)
            return fmt::format("found step {}, expected one from 0 to {}", *request_.explain.step,
                               steps - 1);
        return fmt::format("found {:.6g} s, expected a time from 0 to {:.6g} s",
                           *request_.explain.at,
                           static_cast<double>(steps - 1) * model_.step_seconds);
    }

    const plan::Plan& plan_;
    const check::Model& model_;
    const Request& request_;
    diag::Sink& sink_;
    explain::Observations observations_;
    std::vector<History> histories_;  ///< one per monitor of the plan
    std::size_t chosen_ = 0;
};

}  // namespace

bool explain(const source::File& spec, const Compiled& compiled, const Request& request,
             diag::Sink& sink) {
    const check::Model& model = *compiled.plan.model;
    if (!check_names({&model}, request.names, sink)) return false;
    if (!check_outputs({request.output}, files_read(model, spec, {request.trace}), sink))
        return false;
    const auto text = Explaining(compiled, request, sink).text();
    if (text)
        episodes::warn_of_unmarked(model, compiled.plan.inputs, {request.trace}, request.names,
                                   sink);
    OutputFiles output(sink);
    return text && output.add(request.output, *text) && output.commit();
}

}  // namespace etlc::driver
