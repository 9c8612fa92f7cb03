#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/datasets/stored_images.hpp"
#include "data/datasets/trace.hpp"
#include "data/files/file.hpp"
#include "data/files/lfs.hpp"
#include "data/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

/// How far the begin of an episode may be from a frame of its video, in frames.
constexpr double kTolerance = 0.1;

/// As many frames as there are steps.
class ClipFrames final : public FrameSource {
public:
    ClipFrames(std::unique_ptr<FrameSource> frames, std::string video, std::uint64_t steps)
        : frames_(std::move(frames)), video_(std::move(video)), steps_(steps) {}

    diag::Result<bool> next(Frame& frame) override {
        auto more = frames_->next(frame);
        if (!more) {
            Failure failure = more.failure();
            failure.message = fmt::format("{}: {}", video_, failure.message);
            return failure;
        }
        if (*more) ++taken_;
        if (*more ? taken_ > steps_ : taken_ < steps_)
            return Failure{Code::video_out_of_step,
                           fmt::format("{}: has {} {}, the rows of the episode give {}", video_,
                                       *more ? "more than" : "only",
                                       diag::counted(*more ? steps_ : taken_, "step"), steps_)};
        return more;
    }

private:
    std::unique_ptr<FrameSource> frames_;
    std::string video_;
    std::uint64_t steps_;
    std::uint64_t taken_ = 0;
};

}  // namespace

diag::Result<std::string> camera_of(const Dataset& set, const std::string& asked) {
    const std::vector<std::string> cameras = set.cameras();
    if (asked.empty() && cameras.size() == 1) return cameras[0];
    if (asked.empty() && !cameras.empty())
        return Failure{
            Code::no_such_camera,
            fmt::format("has the cameras {}; name one: --camera {}", listed(cameras), cameras[0])};
    if (std::find(cameras.begin(), cameras.end(), asked) != cameras.end()) return asked;
    if (cameras.empty()) return Failure{Code::no_such_camera, "has no camera"};
    return Failure{Code::no_such_camera,
                   fmt::format("has no camera {}, but {}", in_quotes(asked), listed(cameras))};
}

std::string camera_lack(const Dataset& set, const DatasetEpisode& episode,
                        const std::string& camera) {
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
    const double frames = std::round((clip.end - clip.begin) * set.fps());
    if (!clip.is_whole && frames != static_cast<double>(episode.length))
        return fmt::format("it has {}, and from {:.6g} to {:.6g} s in {}, {:.6g} frames",
                           diag::counted(episode.length, "row"), clip.begin, clip.end, clip.path,
                           frames);
    return "";
}

diag::Result<std::unique_ptr<FrameSource>> open_clip(const Dataset& set,
                                                     const DatasetEpisode& episode,
                                                     const std::string& camera,
                                                     std::uint64_t stride) {
    const auto found = episode.clips.find(camera);
    if (found == episode.clips.end()) return open_stored_images(set, episode, camera, stride);
    const Clip& clip = found->second;
    FrameChoice choice{.rate = set.fps() / static_cast<double>(stride)};
    if (!clip.is_whole) {
        choice.first = static_cast<std::uint64_t>(std::llround(clip.begin * set.fps()));
        choice.count = episode.length;
    }
    auto frames = open_video(set.path_of(clip.path), choice);
    if (!frames) return frames;
    return std::unique_ptr<FrameSource>(std::make_unique<ClipFrames>(
        std::move(*frames), clip.path, (episode.length + stride - 1) / stride));
}

}  // namespace etlc::data
