#include "label/frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

#include "data/datasets/dataset.hpp"
#include "data/datasets/trace.hpp"
#include "data/files/file.hpp"
#include "data/recordings/image_arrays.hpp"
#include "data/text/number.hpp"
#include "data/text/quote.hpp"

namespace etlc::label {

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;
using report::Picture;

constexpr std::uint32_t kMostSide = 480;  ///< pixels of a picture
constexpr std::size_t kMostPictureBytes = 256U << 20U;
constexpr std::uint64_t kMostPassed = 64;  ///< frames that are decoded rather than skipped
constexpr std::uint64_t kBefore = 16;      ///< frames before the one asked for
constexpr std::uint64_t kMostFileBytes = 64U << 20U;

void append(std::string& bytes, std::uint32_t number, unsigned size) {
    for (unsigned i = 0; i < size; ++i) bytes += static_cast<char>(number >> (8 * i) & 0xFFU);
}

Failure of_path(const Failure& failure, const std::string& path) {
    return {failure.code, fmt::format("{}: {}", path, failure.message)};
}

diag::Result<ImageFile> image_file(const std::string& path) {
    auto bytes = data::read_file(path, kMostFileBytes, Code::not_pictures);
    if (!bytes) return of_path(bytes.failure(), path);
    if (bytes->starts_with("\x89PNG")) return ImageFile{"image/png", std::move(*bytes)};
    if (bytes->starts_with("\xFF\xD8\xFF")) return ImageFile{"image/jpeg", std::move(*bytes)};
    return Failure{Code::not_pictures, path + ": expected a PNG or JPEG file"};
}

/// Returns the number at the end of a name: 3 for "pick-000003".
std::optional<std::uint64_t> number_at_end(const std::string& name) {
    const std::size_t last = name.find_last_not_of("0123456789");
    return data::parse_whole<std::uint64_t>(
        std::string_view(name).substr(last == std::string::npos ? 0 : last + 1));
}

}  // namespace

ImageFile bitmap(const Picture& picture) {
    constexpr std::uint32_t kHead = 54;
    const std::uint32_t row = (3 * picture.width + 3) / 4 * 4;
    std::string bytes = "BM";
    append(bytes, kHead + row * picture.height, 4);
    append(bytes, 0, 4);
    append(bytes, kHead, 4);
    append(bytes, kHead - 14, 4);
    append(bytes, picture.width, 4);
    append(bytes, picture.height, 4);
    append(bytes, 1, 2);
    append(bytes, 24, 2);
    for (int i = 0; i < 6; ++i) append(bytes, 0, 4);
    bytes.resize(kHead + std::size_t{row} * picture.height);
    char* to = &bytes[kHead];
    for (std::size_t y = picture.height; y-- > 0; to += row) {
        const char* const from = &picture.pixels[3 * y * picture.width];
        for (std::size_t x = 0; x < 3 * std::size_t{picture.width}; x += 3)
            for (std::size_t c = 0; c < 3; ++c) to[x + c] = from[x + 2 - c];
    }
    return {"image/bmp", std::move(bytes)};
}

/// Returns the episode of a data set that shows this one, or an empty text.
std::string Frames::dataset_episode(const Episode& episode) const {
    const std::string& text = request_.option.text;
    if (text.empty()) return data::dataset_path(episode.path) ? episode.path : "";
    if (!data::is_dataset(text)) return "";
    const auto number = number_at_end(fs::path(episode.path).stem().string());
    return number ? data::episode_path(text, *number) : "";
}

bool Frames::has(const Episode& episode) const {
    const std::string of_set = dataset_episode(episode);
    if (of_set.empty()) return !request_.option.text.empty();
    const auto found = data::find_episode(of_set);
    return found && !found->set->cameras().empty();
}

diag::Result<std::unique_ptr<data::FrameSource>> Frames::open_dataset(const std::string& episode) {
    file_ = episode;
    const auto found = data::find_episode(episode);
    if (!found) return found.failure();
    const auto camera = data::camera_of(*found->set, request_.camera);
    if (!camera) return camera.failure();
    const double rate = request_.step_seconds > 0 ? 1 / request_.step_seconds : 0;
    const auto stride = data::rows_a_step(*found->set, rate);
    if (!stride) return stride.failure();
    return data::open_clip(*found->set, *found->episode, *camera, *stride);
}

/// Opens the frames of an episode from a step on, or from the first one.
diag::Result<std::unique_ptr<data::FrameSource>> Frames::open(const Episode& episode,
                                                              std::uint64_t from) {
    next_ = 0;
    can_skip_ = false;
    if (const std::string of_set = dataset_episode(episode); !of_set.empty())
        return open_dataset(of_set);
    if (!request_.option.is_pattern()) {
        file_ = episode.path;
        return data::open_image_array(episode.path, request_.option.text);
    }
    const std::vector<std::string> paths = report::files_of_frames(request_.option, episode.path);
    file_ = paths.empty() ? "--frames " + request_.option.text : paths[0];
    if (paths.size() != 1 || !data::is_video(paths[0]))
        return Failure{Code::no_frames,
                       fmt::format("found {}, expected {}, one per step",
                                   diag::counted(paths.size(), "picture"), episode.steps)};
    can_skip_ = true;
    next_ = from;
    data::FrameChoice choice;
    choice.rate = request_.step_seconds > 0 ? 1 / request_.step_seconds : 0;
    choice.skipped = from;
    return data::open_video(paths[0], choice);
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
    data::Frame frame;
    while (next_ <= step) {
        const auto more = source_->next(frame);
        if (!more) return of_path(more.failure(), file_);
        if (!*more)
            return Failure{Code::no_frames, fmt::format("{}: ends before step {}", file_, step)};
        Picture picture = report::shrunk(frame.rgb, frame.width, frame.height, 3, kMostSide);
        if (const auto [at, is_new] = pictures_.try_emplace(next_, std::move(picture)); is_new)
            bytes_ += at->second.pixels.size();
        ++next_;
        make_room(step);
    }
    return std::nullopt;
}

diag::Result<ImageFile> Frames::at(const Episode& episode, std::uint64_t step) {
    if (episode.path != std::exchange(episode_, episode.path)) {
        source_.reset();
        pictures_.clear();
        bytes_ = 0;
    }
    if (request_.option.is_pattern() && !data::is_dataset(request_.option.text)) {
        const auto paths = report::files_of_frames(request_.option, episode.path);
        if (paths.size() == episode.steps && !data::is_video(paths[0]))
            return image_file(paths[step]);
    }
    if (const auto known = pictures_.find(step); known != pictures_.end())
        return bitmap(known->second);
    const bool is_ahead = source_ && next_ <= step && (step - next_ <= kMostPassed || !can_skip_);
    if (!is_ahead) {
        auto opened = open(episode, step - std::min(step, kBefore));
        if (!opened) return of_path(opened.failure(), file_);
        source_ = std::move(*opened);
    }
    if (auto failure = read_up_to(step)) {
        source_.reset();
        return *failure;
    }
    return bitmap(pictures_.at(step));
}

}  // namespace etlc::label
