#include "data/frames/frames.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "data/files/child.hpp"
#include "data/files/file.hpp"
#include "data/frames/protocol.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;

constexpr std::string_view kEmbedder = "etlc-embed";

std::string in_small_letters(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

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

}  // namespace

std::string in_colour(std::string_view grey) {
    std::string rgb;
    rgb.reserve(3 * grey.size());
    for (const char value : grey) rgb.append(3, value);
    return rgb;
}

bool is_video(const std::string& path) {
    constexpr std::array<std::string_view, 8> kEndings = {".mp4",  ".mkv", ".avi", ".mov",
                                                          ".webm", ".gif", ".m4v", ".ts"};
    const std::string small = in_small_letters(path);
    return std::any_of(kEndings.begin(), kEndings.end(),
                       [&](std::string_view ending) { return small.ends_with(ending); });
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

namespace {

diag::Result<std::unique_ptr<FrameSource>> start(const std::vector<std::string>& arguments,
                                                 Decoded decoded) {
    auto child = Child::start(embedder_path(), arguments,
                              {.max_silence_seconds = frames::kMaxSilenceSeconds, .heard = true});
    if (!child) return no_embedder();
    return std::unique_ptr<FrameSource>(
        std::make_unique<DecodedFrames>(std::move(child), std::move(decoded)));
}

}  // namespace

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

ImageDecoder::ImageDecoder(std::unique_ptr<Child> child) : child_(std::move(child)) {}
ImageDecoder::~ImageDecoder() = default;

diag::Result<std::unique_ptr<ImageDecoder>> ImageDecoder::start() {
    auto child = Child::start(
        embedder_path(), {"given"},
        {.max_silence_seconds = frames::kMaxSilenceSeconds, .fed = true, .heard = true});
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
    auto child = Child::start(
        embedder_path(), {"png"},
        {.max_silence_seconds = frames::kMaxSilenceSeconds, .fed = true, .heard = true});
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

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;

const std::vector<std::string> kEndings = {".png", ".jpg", ".jpeg"};

}  // namespace

bool is_image(const std::string& path) {
    const std::string small = in_small_letters(path);
    return std::any_of(kEndings.begin(), kEndings.end(),
                       [&](const std::string& ending) { return small.ends_with(ending); });
}

std::string image_endings() {
    return diag::alternatives(kEndings);
}

diag::Result<std::vector<std::string>> find_images(const std::string& folder,
                                                   const std::string& path) {
    const std::string prefix = folder.empty() || fs::path(path).is_absolute() ? "" : folder + "/";
    const std::string whole = prefix + path;
    std::error_code error;
    std::vector<std::string> images;
    if (fs::is_directory(whole, error)) {
        const std::string separator = path.empty() || path.ends_with('/') ? "" : "/";
        for (const auto& entry : fs::directory_iterator(whole, error))
            if (is_image(entry.path().string()))
                images.push_back(path + separator + entry.path().filename().string());
    } else if (!why_unreadable(whole)) {
        if (!is_image(path))
            return Failure{Code::unreadable_image,
                           fmt::format("unknown kind of image, expected {}", image_endings())};
        images.push_back(path);
    } else {
        const auto matches = paths_matching(literal(prefix) + path);
        for (const std::string& match : matches.value_or(std::vector<std::string>{}))
            if (is_image(match)) images.push_back(match.substr(prefix.size()));
    }
    std::sort(images.begin(), images.end());
    if (images.empty())
        return Failure{Code::unreadable_image,
                       fmt::format("no such image, folder of images or pattern of some, expected "
                                   "files that end in {}",
                                   image_endings())};
    return images;
}

}  // namespace etlc::data
