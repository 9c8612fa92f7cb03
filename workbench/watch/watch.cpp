#include "watch/watch.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/recording.hpp"
#include "recordings/frames/frames.hpp"
#include "source/text.hpp"
#include "watch/camera.hpp"
#include "watch/page.hpp"
#include "watch/summary.hpp"

namespace etlc::watch {

namespace {

using check::Index;
using check::kNone;
using diag::Code;
using diag::Failure;

class Watch {
public:
    Watch(const plan::Plan& plan, const Request& request, diag::Sink& sink)
        : plan_(plan),
          request_(request),
          sink_(sink),
          stop_(request.video.empty()),
          monitors_(plan),
          changes_(plan),
          summary_(plan) {
        if (!request.record.empty()) incidents_.emplace(plan, request.record);
    }

    bool run() {
        if (!request_.video.empty() && !open_camera()) return is_stopped();
        if (request_.video.empty())
            episodes::warn_of_unmarked(*plan_.model, plan_.inputs,
                                       {std::string(recordings::kStandardInput)}, request_.names,
                                       sink_);
        if (sink_.refused() || (request_.has_page && !open_page())) return false;
        step_through();
        const auto trouble = incidents_ ? incidents_->close() : std::nullopt;
        if (trouble) sink_.report(*trouble);
        request_.print(text());
        return !sink_.has_errors();
    }

private:
    const std::string& source() const {
        static const std::string standard_input = "standard input";
        return request_.video.empty() ? standard_input : request_.video;
    }

    /// Nothing has failed where somebody asked for the end before the first step.
    bool is_stopped() const { return stop_.is_asked() && !sink_.has_errors(); }

    bool fail(const Failure& failure) {
        sink_.report(request_.video.empty() ? recordings::in_trace(failure, "-")
                                            : data::in_file(failure, source()));
        return false;
    }

    /// A video gives nothing but frames.
    bool has_only_encoded_inputs() {
        for (const Index i : plan_.inputs) {
            const check::Input& input = plan_.model->inputs[i];
            if (input.encoder != kNone) continue;
            sink_
                .report(Code::no_such_channel, input.span,
                        fmt::format("'{}' is made by no encoder, and a video gives frames only",
                                    input.name))
                .note(
                    "declare what makes it (input z : f32[D] by ENCODER), or pass all inputs as a "
                    "trace: --trace -");
            return false;
        }
        return true;
    }

    /// Opens the source last: while encoders start, its frames would be lost.
    bool open_camera() {
        if (!has_only_encoded_inputs()) return false;
        if (const auto failure = recordings::why_no_source(request_.video)) return fail(*failure);
        embed::Request asked{request_.running, request_.version, {}, {}, {}};
        auto encoders = Encoders::start(*plan_.model, plan_.inputs, std::move(asked), stop_, sink_);
        if (!encoders) return false;
        const double length = plan_.model->step_seconds;
        auto frames = recordings::LiveFrames::open(request_.video, length > 0 ? 1 / length : 0);
        if (!frames) return fail(frames.failure());
        camera_ =
            std::make_unique<Camera>(std::move(*frames), std::move(encoders),
                                     recordings::is_live_source(request_.video), length, stop_);
        return true;
    }

    bool open_page() {
        auto page = Page::start(request_.port,
                                page_of(plan_, {request_.spec_path, source(), camera_ != nullptr}));
        if (!page) {
            sink_.report(data::in_file(page.failure(), "the page"));
            return false;
        }
        page_ = std::move(*page);
        return request_.print(page_->address() + "\n");
    }

    diag::Result<episodes::Recording> open() {
        const episodes::Wanted wanted{plan_.model, plan_.inputs, {}, {}, nullptr, {}};
        if (!camera_) {
            const std::string trace(recordings::kStandardInput);
            return episodes::Recording::open(wanted, trace, {request_.names, nullptr});
        }
        return episodes::Recording::open(
            wanted,
            [this](const std::vector<data::Channel>& channels)
                -> diag::Result<std::unique_ptr<data::Trace>> {
                std::vector<Index> inputs;
                for (const data::Channel& channel : channels) inputs.push_back(input_of(channel));
                return std::unique_ptr<data::Trace>(
                    std::make_unique<CameraTrace>(*camera_, std::move(inputs), channels));
            });
    }

    Index input_of(const data::Channel& channel) const {
        for (const Index i : plan_.inputs)
            if (plan_.model->inputs[i].name == channel.name) return i;
        return kNone;
    }

    void step_through() {
        auto recording = open();
        if (!recording) {
            fail(recording.failure());
            return;
        }
        const auto done = episodes::replay(*recording, {&monitors_}, [&] { return step(); });
        // Where somebody asks for the end, a row may be cut, and there may be no step.
        const bool is_cut = stop_.is_asked() && (!camera_ || steps_ == 0);
        if (!done && !is_cut && !sink_.has_errors()) fail(done.failure());
    }

    bool step() {
        // A row that arrives with the end may be cut.
        if (!camera_ && stop_.is_asked()) return false;
        const auto& verdicts = monitors_.verdicts();
        const execute::Evaluator& evaluator = monitors_.evaluator();
        for (std::size_t m = 0; m < verdicts.size(); ++m)
            if (monitors_.reports(plan_.monitors[m].index)) summary_.add(m, steps_, verdicts[m]);
        const auto trouble = incidents_ ? incidents_->step(evaluator, verdicts) : std::nullopt;
        std::string lines = changes_.after(steps_, verdicts, evaluator) + changed(trouble);
        if (page_) lines += show(verdicts);
        ++steps_;
        return lines.empty() || request_.print(source::visible_lines(lines));
    }

    /// Passes a step to the page; returns the line that says that the page has ended.
    std::string show(const std::vector<etlmon::Verdict>& verdicts) {
        page_->add(step_json(plan_, steps_, verdicts, monitors_.evaluator()),
                   camera_ ? camera_->frame() : nullptr);
        const auto why = page_->take_ending();
        return why ? fmt::format("{}: the page has ended: {}\n", when(*plan_.model, steps_), *why)
                   : "";
    }

    /// Returns the line that says that incidents cannot be written, or can again.
    std::string changed(const std::optional<diag::Diagnostic>& trouble) {
        if (trouble.has_value() == is_in_trouble_) return "";
        is_in_trouble_ = trouble.has_value();
        return fmt::format(
            "{}: incidents {}\n", when(*plan_.model, steps_),
            trouble ? fmt::format("cannot be written: {}: {}", trouble->file, trouble->message)
                    : "are written again");
    }

    std::string text() const {
        std::string text = summary_.text(steps_, monitors_.evaluator());
        if (camera_) {
            const CameraCounts& counts = camera_->counts();
            text += fmt::format("{}", diag::counted(counts.frames, "frame"));
            if (counts.late > 0) text += fmt::format(", {} more than the steps need", counts.late);
            if (counts.dropped > 0)
                text += fmt::format(", {} dropped while the encoder was busy", counts.dropped);
            if (counts.absent > 0)
                text += fmt::format("; no frame for {}", diag::counted(counts.absent, "step"));
            text += "\n";
        }
        if (incidents_) text += incidents_->text();
        return source::visible_lines(text);
    }

    const plan::Plan& plan_;
    const Request& request_;
    diag::Sink& sink_;
    Stop stop_;
    episodes::Follower monitors_;
    Changes changes_;
    Summary summary_;
    std::optional<Incidents> incidents_;
    std::unique_ptr<Camera> camera_;
    std::unique_ptr<Page> page_;
    std::uint64_t steps_ = 0;
    bool is_in_trouble_ = false;  ///< incidents could not be written at the last step
};

}  // namespace

bool watch(const plan::Plan& plan, const Request& request, diag::Sink& sink) {
    return Watch(plan, request, sink).run();
}

namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};

volatile sig_atomic_t is_asked_now = 0;
std::array<int, 2> ends = {-1, -1};
int nothing = -1;  ///< /dev/null, in place of standard input

void ask(int) {
    is_asked_now = 1;
    const char byte = 0;
    static_cast<void>(!::write(ends[1], &byte, 1));
    if (nothing >= 0) ::dup2(nothing, STDIN_FILENO);
}

}  // namespace

Stop::Stop(bool ends_input) {
    is_asked_now = 0;
    if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) ends = {-1, -1};
    if (ends_input) nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    struct sigaction action {};
    action.sa_handler = ask;
    action.sa_flags = SA_RESETHAND;
    for (const int signal : kSignals) ::sigaction(signal, &action, nullptr);
}

Stop::~Stop() {
    for (const int signal : kSignals) ::signal(signal, SIG_DFL);
    for (int* const descriptor : {&ends[0], &ends[1], &nothing}) {
        if (*descriptor >= 0) ::close(*descriptor);
        *descriptor = -1;
    }
}

bool Stop::is_asked() const {
    return is_asked_now != 0;
}

int Stop::descriptor() const {
    return ends[0];
}

namespace fs = std::filesystem;
using etlmon::Verdict;

Incidents::Incidents(const plan::Plan& plan, std::string folder)
    : plan_(plan), folder_(std::move(folder)), recorder_(plan), alarms_(plan.monitors.size()) {
    std::error_code error;
    while (fs::exists(path(next_), error)) ++next_;
}

std::string Incidents::path(std::uint64_t number) const {
    return (fs::path(folder_) / fmt::format("{}-incident-{}", plan_.model->name, number)).string();
}

/// As the recorder counts: each alarm of a monitor that begins again with it is a new one.
bool Incidents::begins(const std::vector<Verdict>& verdicts) {
    bool begins = false;
    for (std::size_t m = 0; m < verdicts.size(); ++m) {
        const bool repeats = plan_.monitors[m].restarts == check::Restarts::when_final;
        begins = begins || (verdicts[m].alarm() && (repeats || !alarms_[m]));
        alarms_[m] = verdicts[m].alarm();
    }
    return begins;
}

std::optional<diag::Diagnostic> Incidents::step(const execute::Evaluator& evaluator,
                                                const std::vector<Verdict>& verdicts) {
    recorder_.step(evaluator, verdicts);
    is_noted_ = !begins(verdicts) && is_noted_;
    if (!is_noted_) {
        execute::FlightRecorder now = recorder_;
        now.close();
        begun_ = now.complete();
        for (std::uint32_t n = written_; n < begun_; ++n)
            if (auto trouble = write(now, n)) return trouble;
        is_noted_ = true;
    }
    return write_complete();
}

std::optional<diag::Diagnostic> Incidents::close() {
    recorder_.close();
    begun_ = recorder_.complete();
    return write_complete();
}

/// Writes what is complete, and makes room once all is in files.
std::optional<diag::Diagnostic> Incidents::write_complete() {
    for (; written_ < recorder_.complete(); ++written_)
        if (auto trouble = write(recorder_, written_)) return trouble;
    if (written_ == 0 || written_ < begun_) return std::nullopt;
    lost_ += recorder_.lost();
    recorder_.forget();
    before_ += written_;
    numbers_.clear();
    written_ = begun_ = 0;
    return std::nullopt;
}

/// Writes an incident: at first under a number that is free, though another call may watch into the
/// same folder, then again in the same file.
std::optional<diag::Diagnostic> Incidents::write(execute::FlightRecorder& recorder,
                                                 std::uint32_t incident) {
    const std::vector<std::uint8_t>& bytes = recorder.write(incident);
    const bool is_new = incident == numbers_.size();
    std::error_code error;
    for (;; ++next_) {
        const std::string to = path(is_new ? next_ : numbers_[incident]);
        const auto is_free = [&]() -> std::optional<diag::Failure> {
            if (!is_new || !fs::exists(to, error)) return std::nullopt;
            return diag::Failure{diag::Code::unwritable_output, "is another incident"};
        };
        const auto failure = data::write_file_atomically(
            to, {reinterpret_cast<const char*>(bytes.data()), bytes.size()},
            diag::Code::unwritable_output, is_free);
        if (failure && is_new && fs::exists(to, error)) continue;
        if (failure) return data::in_file(*failure, to);
        if (is_new) numbers_.push_back(next_++);
        return std::nullopt;
    }
}

std::string Incidents::text() const {
    std::string text =
        fmt::format("{} in {}", diag::counted(before_ + written_, "incident"), folder_);
    const std::uint64_t lost = lost_ + recorder_.lost();
    if (lost > 0) text += fmt::format("; {} found no room", diag::counted(lost, "more alarm"));
    return text + "\n";
}

}  // namespace etlc::watch
