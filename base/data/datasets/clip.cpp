#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/datasets/stored_images.hpp"
#include "data/datasets/trace.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

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

diag::Result<std::unique_ptr<FrameSource>> open_clip(Dataset& set, const DatasetEpisode& episode,
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
    if (!clip.is_whole || stride > 1) {
        const VideoParts& video = set.parts_of(clip.path);
        choice.total = video.frames;
        choice.total_of = fmt::format("of {}, the last of them {}",
                                      diag::counted(video.parts.size(), "episode"), video.last);
    }
    auto frames = open_video(set.path_of(clip.path), choice);
    if (!frames) return frames;
    return std::unique_ptr<FrameSource>(std::make_unique<ClipFrames>(
        std::move(*frames), clip.path, (episode.length + stride - 1) / stride));
}

}  // namespace etlc::data
