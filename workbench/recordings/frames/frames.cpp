#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/frames/frames.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::recordings {

using namespace data;

namespace {

using diag::Code;
using diag::Failure;

constexpr std::string_view kEmbedder = "etlc-embed";

Failure stopped(Child& child, Code code) {
    return {code, fmt::format("is damaged or too much to read: the process that read it {}",
                              child.ending())};
}

/// The code of decoding failures, and the episodes that a video must hold.
struct Decoded {
    Code code;
    std::string total_of;
};

diag::Result<bool> end_of(Child& child, const Decoded& decoded) {
    switch (child.exit_status()) {
        case 0: return false;
        case frames::kRefused: return Failure{decoded.code, child.last_words()};
        case frames::kOutOfStep: return Failure{Code::video_out_of_step, child.last_words()};
        case frames::kNoSuchFrame: return Failure{Code::no_such_frame, child.last_words()};
        case frames::kOtherCount:
            return Failure{Code::video_out_of_step,
                           fmt::format("{} {}", child.last_words(), decoded.total_of)};
        default: return stopped(child, decoded.code);
    }
}

/// Reads the next frame that the process writes; false at the end.
diag::Result<bool> read_frame(Child& child, const Decoded& decoded, Frame& frame) {
    std::array<char, 8> head{};
    if (child.at_end()) return end_of(child, decoded);
    if (!child.read(head.data(), head.size())) return stopped(child, decoded.code);
    frame.height = frames::number_at(head.data());
    frame.width = frames::number_at(head.data() + 4);
    const std::uint64_t pixels = std::uint64_t{frame.height} * frame.width;
    if (pixels == 0 || pixels > frames::kMaxPixels) return stopped(child, decoded.code);
    frame.rgb.resize(3 * pixels);
    if (!child.read(frame.rgb.data(), frame.rgb.size())) return stopped(child, decoded.code);
    return true;
}

class DecodedFrames final : public FrameSource {
public:
    DecodedFrames(std::unique_ptr<Child> child, Decoded decoded)
        : child_(std::move(child)), decoded_(std::move(decoded)) {}

    diag::Result<bool> next(Frame& frame) override { return read_frame(*child_, decoded_, frame); }

private:
    std::unique_ptr<Child> child_;
    Decoded decoded_;
};

/// Starts the program for what arrives on its standard input.
std::unique_ptr<Child> fed(const char* call) {
    return Child::start(
        embedder_path(), {call},
        {.max_silence_seconds = frames::kMaxSilenceSeconds, .fed = true, .heard = true});
}

diag::Result<std::unique_ptr<FrameSource>> start(const std::vector<std::string>& arguments,
                                                 Decoded decoded) {
    auto child = Child::start(embedder_path(), arguments,
                              {.max_silence_seconds = frames::kMaxSilenceSeconds, .heard = true});
    if (!child) return no_embedder();
    return std::unique_ptr<FrameSource>(
        std::make_unique<DecodedFrames>(std::move(child), std::move(decoded)));
}

}  // namespace

bool is_shape_of_images(const std::vector<std::uint64_t>& shape, bool with_grey) {
    const bool has_form = (shape.size() == 4 && shape[3] == 3) || (with_grey && shape.size() == 3);
    return has_form && shape[1] > 0 && shape[2] > 0 &&
           std::max(shape[1], shape[2]) <= frames::kMaxExtent &&
           shape[1] * shape[2] <= frames::kMaxPixels;
}

std::string in_colour(std::string_view grey) {
    std::string rgb;
    rgb.reserve(3 * grey.size());
    for (const char value : grey) rgb.append(3, value);
    return rgb;
}

bool is_video(const std::string& path) {
    static const std::vector<std::string> kEndings = {".mp4",  ".mkv", ".avi", ".mov",
                                                      ".webm", ".gif", ".m4v", ".ts"};
    return has_ending(path, kEndings);
}

std::string embedder_path() {
    if (const char* const path = std::getenv("ETLC_EMBEDDER")) return path;
    return helper_path(kEmbedder);
}

Failure no_embedder() {
    return {Code::no_embedder,
            fmt::format("{} cannot be run, which reads images and video and runs networks; etlc "
                        "builds it where it finds FFmpeg, libpng and libjpeg (Debian: "
                        "libavformat-dev, libswscale-dev, libpng-dev, libjpeg62-turbo-dev); of the "
                        "packages of etlc, etlc-embed has it",
                        in_quotes(embedder_path()))};
}

diag::Result<std::unique_ptr<FrameSource>> open_video(const std::string& path,
                                                      const FrameChoice& choice) {
    if (auto why = why_unreadable(path)) return Failure{Code::unreadable_video, *why};
    std::vector<std::string> arguments = {"video", path};
    const auto add = [&](std::string_view option, const std::string& value) {
        arguments.insert(arguments.end(), {std::string(option), value});
    };
    if (!choice.only.empty()) add("--only", fmt::format("{}", fmt::join(choice.only, ",")));
    if (choice.first > 0) add("--first", std::to_string(choice.first));
    if (choice.count < UINT64_MAX) add("--count", std::to_string(choice.count));
    if (choice.rate > 0) add("--rate", fmt::format("{}", choice.rate));
    if (choice.skipped > 0) add("--skip", std::to_string(choice.skipped));
    if (choice.total) add("--total", std::to_string(*choice.total));
    return start(arguments, {Code::unreadable_video, choice.total_of});
}

diag::Result<std::unique_ptr<FrameSource>> open_images(const std::vector<std::string>& paths) {
    std::vector<std::string> arguments = {"images"};
    arguments.insert(arguments.end(), paths.begin(), paths.end());
    return start(arguments, {Code::unreadable_image, {}});
}

diag::Result<std::unique_ptr<ImageDecoder>> ImageDecoder::start() {
    auto child = fed("given");
    if (!child) return no_embedder();
    return std::unique_ptr<ImageDecoder>(new ImageDecoder(std::move(child)));
}

std::optional<Failure> ImageDecoder::decode(std::string_view bytes, Frame& frame) {
    constexpr Code kCode = Code::unreadable_image;
    if (bytes.size() > frames::kMaxImageBytes)
        return Failure{kCode, fmt::format("has {} bytes, at most {} are read", bytes.size(),
                                          frames::kMaxImageBytes)};
    std::string head;
    frames::append(head, static_cast<std::uint32_t>(bytes.size()));
    if (child_->give(head)) static_cast<void>(child_->give(bytes));  // what it refuses, it says
    const auto given = read_frame(*child_, {kCode, {}}, frame);
    if (!given) return given.failure();
    if (!*given) return stopped(*child_, kCode);
    return std::nullopt;
}

diag::Result<std::string> png_of(const Frame& frame) {
    const auto child = fed("png");
    if (!child) return no_embedder();
    std::string head;
    frames::append(head, frame.height);
    frames::append(head, frame.width);
    if (child->give(head)) static_cast<void>(child->give(frame.rgb));  // why not, it says
    child->give_no_more();
    std::string png;
    for (char byte = 0; !child->at_end() && child->read(&byte, 1);) png += byte;
    if (child->exit_status() == 0 && !png.empty()) return png;
    return Failure{Code::no_embedder, fmt::format("what writes PNG {}", child->ending())};
}

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
    // A camera may be silent for as long as it likes: the steps go on without it.
    constexpr int kLongSilenceSeconds = 2'000'000;
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

namespace {

constexpr std::uint32_t kHeight = 480;
constexpr std::uint32_t kWidth = 640;

/// Mixes 32 bits; a bijection, "lowbias32" of github.com/skeeto/hash-prospector.
constexpr std::uint32_t mixed(std::uint32_t bits) {
    bits ^= bits >> 16U;
    bits *= 0x7feb352dU;
    bits ^= bits >> 15U;
    bits *= 0x846ca68bU;
    return bits ^ bits >> 16U;
}

/// Random numbers from 0 to 255 at the corners of square cells, interpolated inside of them.
class Noise {
public:
    Noise(std::uint32_t seed, std::uint32_t cell) : cell_(cell), columns_(kWidth / cell + 2) {
        const std::uint32_t row_seed = mixed(seed);
        for (std::uint32_t row = 0; row < kHeight / cell + 2; ++row)
            for (std::uint32_t column = 0; column < columns_; ++column)
                corners_.push_back(mixed(column + mixed(row + row_seed)) >> 24U);
    }

    std::uint32_t at(std::uint32_t y, std::uint32_t x) const {
        const std::uint32_t down = y % cell_;
        const std::uint32_t right = x % cell_;
        const std::uint32_t* above = &corners_[y / cell_ * columns_ + x / cell_];
        const std::uint32_t* below = above + columns_;
        const std::uint32_t top = above[0] * (cell_ - right) + above[1] * right;
        const std::uint32_t bottom = below[0] * (cell_ - right) + below[1] * right;
        return (top * (cell_ - down) + bottom * down) / (cell_ * cell_);
    }

private:
    std::uint32_t cell_;
    std::uint32_t columns_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

Frame reference_frame(std::uint32_t index) {
    constexpr std::uint32_t kColours = 3;
    Frame frame{kHeight, kWidth, std::string(std::size_t{kHeight} * kWidth * kColours, '\0')};
    for (std::uint32_t colour = 0; colour < kColours; ++colour) {
        const std::uint32_t seed = 16 * index + 4 * colour;
        const std::uint32_t mean = 32 + (index + colour) % kColours * 96;
        const Noise coarse(seed + 3, 64), middle(seed + 2, 16), fine(seed + 1, 4), dots(seed, 1);
        for (std::uint32_t y = 0; y < kHeight; ++y)
            for (std::uint32_t x = 0; x < kWidth; ++x)
                frame.rgb[(y * kWidth + x) * kColours + colour] =
                    static_cast<char>((2 * coarse.at(y, x) + 2 * middle.at(y, x) + fine.at(y, x) +
                                       dots.at(y, x) + 2 * mean) /
                                      8);
    }
    return frame;
}

}  // namespace etlc::recordings
