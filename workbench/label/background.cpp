#include "label/background.hpp"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "data/files/child.hpp"

namespace etlc::label {

namespace {

using namespace std::chrono_literals;

constexpr auto kQuiet = 700ms;            ///< without a key, before proposals are made
constexpr int kMaxSilenceSeconds = 3600;  ///< of the process that makes them

/// Runs this program. Returns its output, or a sentence in place of proposals.
std::string output_of(const std::vector<std::string>& call) {
    const auto none = [](const std::string& why) {
        return nlohmann::json{{"why_none", "the process that makes them " + why},
                              {"proposals", nlohmann::json::array()}}
            .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    };
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    const auto child = data::Child::start(
        self.string(), call,
        {.max_silence_seconds = kMaxSilenceSeconds, .whole_environment = true, .heard = true});
    if (!child) return none("cannot be started");
    std::string output;
    while (!child->at_end()) {
        const std::size_t before = output.size();
        const std::size_t more = child->arrived();
        output.resize(before + more);
        child->read(output.data() + before, more);
    }
    if (!output.empty()) return output;
    const int status = child->exit_status();
    return none(status < 0 ? child->ending() : "failed: " + child->last_words());
}

/// Returns the labels of the episodes that are fully labelled, as text to compare.
std::string lesson_of(const Desk& desk) {
    std::string text;
    for (std::size_t e = 0; e < desk.episodes().size(); ++e) {
        if (!desk.is_labelled(e)) continue;
        text += fmt::format("{}:", e);
        for (std::size_t p = 0; p < desk.predicates().size(); ++p)
            for (const Interval& one : desk.marks(e, p).value_or(std::vector<Interval>()))
                text +=
                    fmt::format("{} {} {} {};", p, one.start, one.end, static_cast<int>(one.label));
    }
    return text;
}

}  // namespace

void Background::look_after(const Desk& desk) {
    if (running_.valid() && running_.wait_for(0s) == std::future_status::ready) {
        auto parsed = parse_proposals(running_.get(), desk);
        proposals_ = parsed ? std::move(*parsed) : Proposals{"they cannot be read", {}};
        ++version_;
    }
    if (std::exchange(seen_, desk.version()) != desk.version()) changed_ = Clock::now();
    if (running_.valid() || Clock::now() - changed_ < kQuiet) return;
    const std::size_t labelled = labelled_episodes(desk).size();
    if (labelled < kEnoughLabelled || labelled == desk.episodes().size()) return;
    std::string lesson = lesson_of(desk);
    if (lesson == learned_) return;
    try {
        running_ = std::async(std::launch::async, output_of, call_);
        learned_ = std::move(lesson);
    } catch (const std::exception&) {  // no thread can be started now
        changed_ = Clock::now();
    }
}

}  // namespace etlc::label
