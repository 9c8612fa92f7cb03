#include "driver/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "data/file.hpp"
#include "data/trace.hpp"
#include "driver/names.hpp"
#include "driver/progress.hpp"
#include "plan/evaluator.hpp"

namespace etlc::driver {

namespace {

using etlmon::Verdict;

constexpr std::size_t kBufferBytes = 1U << 16U;
constexpr std::uint64_t kStepsPerReport = 4096;

data::Channel channel_of(const check::Input& input) {
    const bool flag = input.type == check::InputType::boolean;
    const auto kind = flag                   ? data::Channel::Kind::boolean
                      : input.is_embedding() ? data::Channel::Kind::vector
                                             : data::Channel::Kind::scalar;
    return {input.name, kind, input.dimension};
}

const char* status(const Verdict& verdict) {
    if (!verdict.decided()) return "undecided";
    return verdict.satisfied() ? "satisfied" : verdict.violated() ? "violated" : "unknown";
}

class Run {
public:
    Run(const Compiled& compiled, const RunRequest& request, diag::Sink& sink)
        : plan_(compiled.plan), request_(request), sink_(sink), evaluator_(compiled.plan) {}

    bool execute() {
        if (!check_names(*plan_.model, request_.names, sink_)) return false;
        auto output = data::AtomicFile::create(request_.output == "-" ? "/dev/stdout" : request_.output,
                                               diag::Code::unwritable_output);
        if (!output) return fail(output.failure(), request_.output);
        output_ = &*output;
        text_ = "step,monitor,lower,robustness,upper,status,final\n";
        if (!step_through_trace() || !flush()) return false;
        const auto failure = output->commit();
        return !failure || fail(*failure, request_.output);
    }

private:
    bool fail(const diag::Failure& failure, const std::string& path) {
        sink_.report(data::in_file(failure, path));
        return false;
    }

    bool step_through_trace() {
        std::vector<data::Channel> channels;
        for (check::Index i : plan_.inputs) channels.push_back(channel_of(plan_.model->inputs[i]));
        auto trace = data::open_trace(request_.trace, data::renamed(channels, request_.names));
        if (!trace) return fail(trace.failure(), request_.trace);
        data::Sample sample;
        std::vector<plan::Sample> samples(plan_.model->inputs.size());
        for (;;) {
            const auto more = (*trace)->next(sample);
            if (!more) return fail(more.failure(), request_.trace);
            if (!*more) break;
            if (!narrow(sample, samples) || !report(evaluator_.step(samples))) return false;
            show_progress((*trace)->length());
        }
        return !request_.finish || finish();
    }

    bool narrow(const data::Sample& sample, std::vector<plan::Sample>& samples) {
        for (std::size_t c = 0; c < plan_.inputs.size(); ++c) {
            const check::Index input = plan_.inputs[c];
            std::string why;
            auto narrowed = plan::narrow(plan_.model->inputs[input], sample.present[c], sample.values[c], why);
            if (!narrowed)
                return fail({diag::Code::trace_value, fmt::format("step {}: {}", step_, why)}, request_.trace);
            samples[input] = std::move(*narrowed);
        }
        return true;
    }

    bool finish() {
        std::uint32_t horizon = 0;
        for (const plan::Monitor& monitor : plan_.monitors) horizon = std::max(horizon, monitor.horizon);
        for (std::uint32_t call = 0; call < horizon; ++call)
            if (!report(evaluator_.finish())) return false;
        return true;
    }

    bool report(const std::vector<Verdict>& verdicts) {
        const auto out = std::back_inserter(text_);
        for (std::size_t m = 0; m < verdicts.size(); ++m) {
            const Verdict& v = verdicts[m];
            const std::string& name = plan_.monitors[m].name;
            if (v.decided())
                fmt::format_to(out, "{},{},{:.9g},{:.9g},{:.9g},{},{}\n", step_, name, v.lower, v.robustness, v.upper,
                               status(v), v.final() ? 1 : 0);
            else
                fmt::format_to(out, "{},{},,,,undecided,0\n", step_, name);
        }
        ++step_;
        return text_.size() < kBufferBytes || flush();
    }

    bool flush() {
        const auto failure = output_->write(text_);
        text_.clear();
        return !failure || fail(*failure, request_.output);
    }

    void show_progress(std::uint64_t length) const {
        if (!watched_ || length == 0 || step_ % kStepsPerReport != 0) return;
        fmt::print(stderr, "\r{:3}% of {} steps", 100 * step_ / length, length);
        if (step_ + kStepsPerReport > length) fmt::print(stderr, kEraseProgress);
    }

    const plan::Plan& plan_;
    const RunRequest& request_;
    diag::Sink& sink_;
    plan::Evaluator evaluator_;
    data::AtomicFile* output_ = nullptr;
    std::string text_;
    std::uint64_t step_ = 0;
    const bool watched_ = progress_is_seen();
};

}  // namespace

bool run(const Compiled& compiled, const RunRequest& request, diag::Sink& sink) {
    return Run(compiled, request, sink).execute();
}

}  // namespace etlc::driver
