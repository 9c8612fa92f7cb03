#include "driver/run.hpp"

#include <fmt/format.h>

#include "data/traces/trace.hpp"
#include "driver/names.hpp"
#include "driver/output_file.hpp"
#include "driver/process.hpp"
#include "driver/progress.hpp"
#include "episodes/replay.hpp"

namespace etlc::driver {

namespace {

using etlmon::Verdict;

constexpr std::size_t kBufferBytes = 1U << 16U;
constexpr std::uint64_t kStepsPerReport = 4096;

const char* status(const Verdict& verdict) {
    if (!verdict.decided()) return "undecided";
    return verdict.satisfied() ? "satisfied" : verdict.violated() ? "violated" : "unknown";
}

class Run {
public:
    Run(const source::File& spec, const Compiled& compiled, const RunRequest& request,
        diag::Sink& sink)
        : spec_(spec.path()),
          plan_(compiled.plan),
          request_(request),
          sink_(sink),
          monitors_(compiled.plan),
          output_(sink) {}

    bool execute() {
        if (!check_names(*plan_.model, request_.names, sink_)) return false;
        std::vector<std::string> inputs = plan_.model->dependencies;
        inputs.insert(inputs.end(), {spec_, data::trace_file(request_.trace)});
        if (!check_outputs({request_.output}, inputs, sink_) || !output_.begin(request_.output))
            return false;
        text_ = "step,monitor,lower,robustness,upper,status,final\n";
        return step_through_trace() && flush() && output_.commit();
    }

private:
    bool fail(const diag::Failure& failure) {
        sink_.report(data::in_trace(failure, request_.trace));
        return false;
    }

    bool step_through_trace() {
        auto recording =
            episodes::Recording::open({plan_.model, plan_.inputs}, request_.trace, request_.names);
        if (!recording) return fail(recording.failure());
        episodes::AfterStep rest;
        if (request_.finish) rest = [&] { return report(); };
        const auto frame = [&] {
            show_progress(recording->length());
            return report();
        };
        const auto done = episodes::replay(*recording, {&monitors_}, frame, rest);
        return done ? *done : fail(done.failure());
    }

    bool report() {
        const std::vector<Verdict>& verdicts = monitors_.verdicts();
        const auto out = std::back_inserter(text_);
        for (std::size_t m = 0; m < verdicts.size(); ++m) {
            const Verdict& v = verdicts[m];
            const std::string& name = plan_.monitors[m].name;
            if (v.decided())
                fmt::format_to(out, "{},{},{:.9g},{:.9g},{:.9g},{},{}\n", step_, name, v.lower,
                               v.robustness, v.upper, status(v), v.final() ? 1 : 0);
            else
                fmt::format_to(out, "{},{},,,,undecided,0\n", step_, name);
        }
        ++step_;
        return text_.size() < kBufferBytes || flush();
    }

    bool flush() {
        const bool written = output_.write(text_);
        text_.clear();
        return written;
    }

    void show_progress(std::uint64_t length) const {
        if (!watched_ || length == 0 || step_ % kStepsPerReport != 0) return;
        print_error(fmt::format("\r{:3}% of {} steps", 100 * step_ / length, length));
        if (step_ + kStepsPerReport > length) print_error(kEraseProgress);
    }

    const std::string& spec_;
    const plan::Plan& plan_;
    const RunRequest& request_;
    diag::Sink& sink_;
    episodes::Follower monitors_;
    OutputFiles output_;
    std::string text_;
    std::uint64_t step_ = 0;
    const bool watched_ = progress_is_seen();
};

}  // namespace

bool run(const source::File& spec, const Compiled& compiled, const RunRequest& request,
         diag::Sink& sink) {
    return Run(spec, compiled, request, sink).execute();
}

}  // namespace etlc::driver
