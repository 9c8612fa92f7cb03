#include "data/frames/live.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "data/files/file.hpp"
#include "data/frames/protocol.hpp"

namespace etlc::data {

namespace {

using diag::Code;
using diag::Failure;

/// A camera may be silent for as long as it likes: the steps go on without it.
constexpr int kLongSilenceSeconds = 2'000'000;

}  // namespace

bool is_live_source(const std::string& source) {
    std::error_code error;
    return source.find("://") != std::string::npos ||
           (std::filesystem::exists(source, error) &&
            !std::filesystem::is_regular_file(source, error) &&
            !std::filesystem::is_directory(source, error));
}

std::optional<Failure> why_no_source(const std::string& source) {
    if (source.find("://") != std::string::npos) return std::nullopt;
    if (!is_live_source(source)) {
        const auto why = why_unreadable(source);
        const bool is_number = source.find_first_not_of("0123456789") == std::string::npos;
        if (why && is_number)
            return Failure{
                Code::unreadable_video,
                fmt::format("{}; a camera is named by its device, /dev/video{}", *why, source)};
        if (why) return Failure{Code::unreadable_video, *why};
    } else if (::access(source.c_str(), R_OK) != 0) {
        return Failure{Code::unreadable_video,
                       fmt::format("cannot be read: {}", std::strerror(errno))};
    }
    return std::nullopt;
}

diag::Result<std::unique_ptr<LiveFrames>> LiveFrames::open(const std::string& source, double rate) {
    const bool is_live = is_live_source(source);
    if (auto failure = why_no_source(source)) return *failure;
    std::vector<std::string> arguments = {"video", source, "--pace", is_live ? "live" : "real"};
    if (!is_live && rate > 0)
        arguments.insert(arguments.end(), {"--rate", fmt::format("{}", rate)});
    auto decoder = Child::start(embedder_path(), arguments,
                                {.max_silence_seconds = kLongSilenceSeconds, .heard = true});
    if (!decoder) return no_embedder();
    return std::unique_ptr<LiveFrames>(new LiveFrames(std::move(decoder)));
}

diag::Result<bool> LiveFrames::take(LiveFrame& frame) {
    for (;;) {
        std::string& pixels = next_.frame.rgb;
        char* const to = has_head_ ? pixels.data() : head_.data();
        const std::size_t whole = has_head_ ? pixels.size() : head_.size();
        filled_ += decoder_->take(to + filled_, whole - filled_);
        if (filled_ < whole) return false;
        filled_ = 0;
        has_head_ = !has_head_;
        if (!has_head_) {
            std::swap(frame, next_);
            return true;
        }
        if (!read_head()) return Failure{Code::unreadable_video, "what decodes it sent no frame"};
    }
}

bool LiveFrames::read_head() {
    const std::uint64_t microseconds =
        frames::number_at(head_.data()) |
        static_cast<std::uint64_t>(frames::number_at(head_.data() + 4)) << 32U;
    next_.time = LiveTime(std::chrono::microseconds(microseconds));
    next_.frame.height = frames::number_at(head_.data() + 8);
    next_.frame.width = frames::number_at(head_.data() + 12);
    const std::uint64_t pixels = std::uint64_t{next_.frame.height} * next_.frame.width;
    if (pixels == 0 || pixels > frames::kMaxPixels) return false;
    next_.frame.rgb.resize(3 * pixels);
    return true;
}

std::optional<Failure> LiveFrames::ending() {
    switch (decoder_->exit_status()) {
        case 0: return std::nullopt;
        case frames::kRefused: return Failure{Code::unreadable_video, decoder_->last_words()};
        case frames::kOutOfStep: return Failure{Code::video_out_of_step, decoder_->last_words()};
        default:
            return Failure{Code::unreadable_video,
                           fmt::format("the process that reads it {}", decoder_->ending())};
    }
}

}  // namespace etlc::data
