#include "watch/incidents.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "data/files/atomic_file.hpp"
#include "data/files/file.hpp"

namespace etlc::watch {

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
