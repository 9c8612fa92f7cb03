#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "data/datasets/dataset.hpp"
#include "data/datasets/trace.hpp"
#include "data/files/file.hpp"
#include "data/files/lfs.hpp"
#include "data/quote.hpp"

namespace etlc::data {
namespace {

/// How far the begin of an episode may be from a frame of its video, in frames.
constexpr double kTolerance = 0.1;

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

/// Why a part is not where the one before it ends; empty: it is. `place`: its first frame, as far
/// as the rows of those before it say. `before`: null of the first.
std::string why_misplaced(const VideoPart* before, const VideoPart& part, double place,
                          double fps) {
    if (before != nullptr && *before->camera != *part.camera)
        return fmt::format("it is the video of two cameras, {} and {}",
                           in_quotes(std::min(*before->camera, *part.camera)),
                           in_quotes(std::max(*before->camera, *part.camera)));
    const double away = part.clip->begin * fps - place;
    const bool is_there = std::abs(away) < 1 - kTolerance;
    if (before == nullptr)
        return is_there ? ""
                        : fmt::format("{} is its first, expected one that begins at 0 s",
                                      in_words(part, fps));
    const std::string both = fmt::format("{} and {}", in_words(*before, fps), in_words(part, fps));
    if (!is_there && away < 0) return both + " overlap";
    if (!is_there) return both + " leave a hole between them";
    if (before->episode->index > part.episode->index)
        return both + " are not in the order of their numbers";
    return "";
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
    std::uint64_t frames = 0;
    for (const VideoPart& part : video.parts) {
        if (video.fault.empty())
            video.fault = why_misplaced(before, part, static_cast<double>(frames), fps_);
        // Of an episode that contradicts itself, its rows tell how long it is.
        const Clip& clip = *part.clip;
        const auto length = static_cast<double>(part.episode->length);
        const bool is_sound = clip.is_whole || frames_of(clip, fps_) == length;
        frames += is_sound ? part.episode->length : found(*part.episode).rows;
        before = &part;
    }
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
