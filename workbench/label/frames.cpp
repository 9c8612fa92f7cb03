#include "label/frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/files/file.hpp"
#include "recordings/frames/protocol.hpp"

namespace etlc::label {

namespace {

using diag::Code;
using diag::Failure;
using report::Picture;

constexpr std::uint32_t kMostSide = 480;  ///< pixels of a picture
constexpr std::size_t kMostPictureBytes = 256U << 20U;
constexpr std::uint64_t kMostPassed = 64;  ///< frames that are decoded rather than skipped
constexpr std::uint64_t kBefore = 16;      ///< frames before the one asked for
constexpr std::uint64_t kMostFileBytes = 64U << 20U;

Failure of_path(const Failure& failure, const std::string& path) {
    return {failure.code,
            path.empty() ? failure.message : fmt::format("{}: {}", path, failure.message)};
}

diag::Result<ImageFile> image_file(const std::string& path) {
    auto bytes = data::read_file(path, kMostFileBytes, Code::not_pictures);
    if (!bytes) return of_path(bytes.failure(), path);
    if (bytes->starts_with("\x89PNG")) return ImageFile{"image/png", std::move(*bytes)};
    if (bytes->starts_with("\xFF\xD8\xFF")) return ImageFile{"image/jpeg", std::move(*bytes)};
    return Failure{Code::not_pictures, path + ": expected a PNG or JPEG file"};
}

}  // namespace

ImageFile bitmap(const Picture& picture) {
    constexpr std::uint32_t kHead = 54;
    const std::uint32_t row = (3 * picture.width + 3) / 4 * 4;
    std::string bytes = "BM";
    constexpr std::uint32_t kPlanes = 1, kBitsPerPixel = 24;
    for (const std::uint32_t number :
         {kHead + row * picture.height, 0U, kHead, kHead - 14, picture.width, picture.height,
          kPlanes | kBitsPerPixel << 16U})
        recordings::frames::append(bytes, number);
    bytes.resize(kHead + std::size_t{row} * picture.height);
    char* to = &bytes[kHead];
    for (std::size_t y = picture.height; y-- > 0; to += row) {
        const char* const from = &picture.pixels[3 * y * picture.width];
        for (std::size_t x = 0; x < 3 * std::size_t{picture.width}; x += 3)
            for (std::size_t c = 0; c < 3; ++c) to[x + c] = from[x + 2 - c];
    }
    return {"image/bmp", std::move(bytes)};
}

diag::Result<report::Film> Frames::open(const Episode& episode, std::uint64_t from) const {
    const double rate = request_.step_seconds > 0 ? 1 / request_.step_seconds : 0;
    return report::open_film(request_.option, episode.path, {episode.steps, rate}, from);
}

/// Fails where a video has other numbers of frames and steps, which only its end tells.
std::optional<Failure> Frames::check_end(const Episode& episode) const {
    const auto end = open(episode, episode.steps - 1);
    if (!end) return end.failure();
    recordings::Frame frame;
    for (const bool is_there : {true, false}) {
        const auto more = end->frames->next(frame);
        const bool is_short = !more && more.failure().code == Code::no_such_frame;
        if (!more && !is_short) return of_path(more.failure(), end->path);
        if (is_short || *more != is_there)
            return Failure{Code::no_frames, fmt::format("{}: found {} than {} pictures, expected "
                                                        "{}, one per step",
                                                        end->path, is_there ? "fewer" : "more",
                                                        episode.steps, episode.steps)};
    }
    return std::nullopt;
}

/// Drops the pictures that are farthest from a step.
void Frames::make_room(std::uint64_t step) {
    while (bytes_ > kMostPictureBytes && pictures_.size() > 1) {
        const auto first = pictures_.begin();
        const auto last = std::prev(pictures_.end());
        const bool is_first =
            step - std::min(step, first->first) > std::max(last->first, step) - step;
        const auto dropped = is_first ? first : last;
        bytes_ -= dropped->second.pixels.size();
        pictures_.erase(dropped);
    }
}

std::optional<Failure> Frames::read_up_to(std::uint64_t step) {
    recordings::Frame frame;
    while (film_.next <= step) {
        const auto more = film_.frames->next(frame);
        if (!more) return of_path(more.failure(), film_.path);
        if (!*more)
            return Failure{Code::no_frames,
                           fmt::format("{}: ends before step {}", film_.path, step)};
        Picture picture = report::shrunk(frame.rgb, frame.width, frame.height, 3, kMostSide);
        if (const auto [at, is_new] = pictures_.try_emplace(film_.next, std::move(picture)); is_new)
            bytes_ += at->second.pixels.size();
        ++film_.next;
        make_room(step);
    }
    return std::nullopt;
}

diag::Result<ImageFile> Frames::at(const Episode& episode, std::uint64_t step) {
    if (episode.path != std::exchange(episode_, episode.path)) {
        film_ = {};
        belongs_ = false;
        pictures_.clear();
        bytes_ = 0;
    }
    if (const auto known = pictures_.find(step); known != pictures_.end())
        return bitmap(known->second);
    const bool is_ahead =
        film_.frames && film_.next <= step && (step - film_.next <= kMostPassed || !film_.can_skip);
    if (!is_ahead) {
        auto opened = open(episode, step - std::min(step, kBefore));
        if (!opened) return opened.failure();
        film_ = std::move(*opened);
    }
    if (!film_.images.empty()) return image_file(std::exchange(film_, {}).images[step]);
    auto failure = belongs_ || !film_.can_skip ? std::nullopt : check_end(episode);
    belongs_ = !failure;
    if (!failure) failure = read_up_to(step);
    if (!failure) return bitmap(pictures_.at(step));
    film_ = {};
    return *failure;
}

}  // namespace etlc::label
