#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "data/datasets/dataset.hpp"
#include "data/datasets/trace.hpp"
#include "data/files/file.hpp"
#include "data/files/lfs.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

/// How far the begin of an episode may be from a frame of its video, in frames.
constexpr double kTolerance = 0.1;
/// What is as far from its place is not there, but where another frame is.
constexpr double kFrame = 1 - kTolerance;

double frames_of(const Clip& clip, double fps) {
    return std::round((clip.end - clip.begin) * fps);
}

std::string in_words(const VideoPart& part, double fps) {
    const Clip& clip = *part.clip;
    const auto length = static_cast<double>(part.episode->length);
    return fmt::format("episode {} ({}, from {:.6g} to {:.6g} s)", part.episode->index,
                       diag::counted(part.episode->length, "row"), clip.begin,
                       clip.is_whole ? clip.begin + length / fps : clip.end);
}

/// Why a part is not where the one before it ends; empty: it is. `before`: null of the first;
/// `away`: frames between its begin and where the rows of all those before it end.
std::string why_misplaced(const VideoPart* before, const VideoPart& part, double away, double fps) {
    const bool is_there = std::abs(away) < kFrame;
    if (before == nullptr)
        return is_there ? ""
                        : fmt::format("{} is its first, expected one that begins at 0 s",
                                      in_words(part, fps));
    const std::string both = fmt::format("{} and {}", in_words(*before, fps), in_words(part, fps));
    if (!is_there) return both + " leave a hole between them";
    if (before->episode->index > part.episode->index)
        return both + " are not in the order of their numbers";
    return "";
}

/// Why two parts cannot both be there; empty: they can. `end`: of the one before, in frames.
std::string why_shared(const VideoPart& before, double end, const VideoPart& part, double fps) {
    if (*before.camera != *part.camera)
        return fmt::format("it is the video of two cameras, {} and {}",
                           in_quotes(std::min(*before.camera, *part.camera)),
                           in_quotes(std::max(*before.camera, *part.camera)));
    if (end - part.clip->begin * fps < kFrame) return "";
    return fmt::format("{} and {} overlap", in_words(before, fps), in_words(part, fps));
}

}  // namespace

const VideoParts& Dataset::parts_of(const std::string& video) {
    const std::lock_guard guard(lock_);
    if (parts_.empty())
        for (const DatasetEpisode& episode : episodes_)
            for (const auto& [camera, clip] : episode.clips)
                parts_[clip.path].parts.push_back({&episode, &camera, &clip});
    VideoParts& parts = parts_[video];
    if (!parts.frames) judge(parts);
    return parts;
}

void Dataset::judge(VideoParts& video) {
    const auto place_of = [](const VideoPart& part) {
        return std::tuple(part.clip->begin, part.episode->index, *part.camera);
    };
    std::sort(video.parts.begin(), video.parts.end(),
              [&](const auto& a, const auto& b) { return place_of(a) < place_of(b); });
    const VideoPart* before = nullptr;
    std::string shared, misplaced;  // the first of either kind
    std::uint64_t frames = 0;
    double end = 0;
    for (const VideoPart& part : video.parts) {
        const Clip& clip = *part.clip;
        const double begin = clip.begin * fps_;
        if (before != nullptr && shared.empty()) shared = why_shared(*before, end, part, fps_);
        if (misplaced.empty())
            misplaced = why_misplaced(before, part, begin - static_cast<double>(frames), fps_);
        // Of an episode that contradicts itself, its rows tell how long it is.
        const auto length = static_cast<double>(part.episode->length);
        const bool is_sound = clip.is_whole || frames_of(clip, fps_) == length;
        const std::uint64_t rows = is_sound ? part.episode->length : found(*part.episode).rows;
        frames += rows;
        end = begin + static_cast<double>(rows);
        before = &part;
    }
    video.fault = shared.empty() ? misplaced : shared;
    video.frames = frames;
    if (before != nullptr) video.last = in_words(*before, fps_);
}

std::string camera_lack(Dataset& set, const DatasetEpisode& episode, const std::string& camera) {
    const auto found = episode.clips.find(camera);
    if (found == episode.clips.end()) return "";  // its images are in the rows
    const Clip& clip = found->second;
    if (auto why = why_unreadable(set.path_of(clip.path)))
        return fmt::format("{}: {}", clip.path, *why);
    if (is_lfs_pointer(set.path_of(clip.path)))
        return fmt::format("{}: {}", clip.path, kIsLfsPointer);
    const double first = clip.begin * set.fps();
    if (std::abs(first - std::round(first)) > kTolerance)
        return fmt::format("it begins at {:.6g} s in {}, where no frame is at {:.6g} a second",
                           clip.begin, clip.path, set.fps());
    const double frames = frames_of(clip, set.fps());
    if (!clip.is_whole && frames != static_cast<double>(episode.length))
        return fmt::format("it has {}, and from {:.6g} to {:.6g} s in {}, {:.6g} frames",
                           diag::counted(episode.length, "row"), clip.begin, clip.end, clip.path,
                           frames);
    if (const std::string& fault = set.parts_of(clip.path).fault; !fault.empty())
        return fmt::format("which frames of {} it has is not known: {}", clip.path, fault);
    return "";
}

}  // namespace etlc::data
