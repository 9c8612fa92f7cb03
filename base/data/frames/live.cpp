#include "data/frames/live.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
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
constexpr std::size_t kHeadBytes = 16;  ///< the time, height and width

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

std::size_t LiveFrames::missing() const {
    return has_head_ ? std::size_t{3} * next_.frame.height * next_.frame.width : kHeadBytes;
}

diag::Result<bool> LiveFrames::take(LiveFrame& frame) {
    if (!has_head_) {
        std::array<char, kHeadBytes> head{};
        if (decoder_->arrived() < head.size()) return false;
        decoder_->read(head.data(), head.size());
        const std::uint64_t microseconds =
            frames::number_at(head.data()) |
            static_cast<std::uint64_t>(frames::number_at(head.data() + 4)) << 32U;
        next_.time = LiveTime(std::chrono::microseconds(microseconds));
        next_.frame.height = frames::number_at(head.data() + 8);
        next_.frame.width = frames::number_at(head.data() + 12);
        has_head_ = true;
    }
    if (missing() == 0 || missing() > 3 * frames::kMaxPixels)
        return Failure{Code::unreadable_video, "what decodes it sent no frame"};
    if (decoder_->arrived() < missing()) return false;
    next_.frame.rgb.resize(missing());
    decoder_->read(next_.frame.rgb.data(), next_.frame.rgb.size());
    std::swap(frame, next_);
    has_head_ = false;
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
