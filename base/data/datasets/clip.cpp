#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "data/datasets/dataset.hpp"
#include "data/datasets/trace.hpp"
#include "data/frames/frames.hpp"
#include "data/parquet/table.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {

namespace {

using diag::Code;
using diag::Failure;

/// Images in the rows of a data set, a struct of bytes and path in each. Only one row and one frame
/// are in memory; a row without its image is a failure that names it.
class StoredImages final : public FrameSource {
public:
    StoredImages(std::unique_ptr<Table> table, std::unique_ptr<ImageDecoder> decoder,
                 const DatasetEpisode& episode, std::string camera, std::uint64_t stride)
        : table_(std::move(table)),
          decoder_(std::move(decoder)),
          rows_(episode.rows),
          camera_(std::move(camera)),
          length_(episode.length),
          stride_(stride) {}

    diag::Result<bool> next(Frame& frame) override {
        for (;;) {
            const auto more = table_->next(cells_);
            if (!more) return of_rows(more.failure());
            if (*more != (row_ < length_))
                return of_rows({Code::unreadable_dataset,
                                "has other rows than before: it has changed meanwhile"});
            if (!*more) return false;
            if (row_ % stride_ == 0) break;
            ++row_;
        }
        if (auto failure = decode(frame)) {
            failure->message =
                fmt::format("row {} of the episode: {}: {}", row_, camera_, failure->message);
            return of_rows(*failure);
        }
        ++row_;
        return true;
    }

private:
    std::optional<Failure> decode(Frame& frame) {
        const Table::Cell& image = cells_[0];
        const Table::Cell& path = cells_[1];
        if (!image.is_null && !image.texts[0].empty())
            return decoder_->decode(image.texts[0], frame);
        if (!path.is_null && !path.texts[0].empty())
            return Failure{Code::unreadable_image,
                           fmt::format("has no bytes and the path {}, which is not read: expected "
                                       "the image itself",
                                       in_quotes(path.texts[0]))};
        return Failure{
            Code::unreadable_image,
            fmt::format("is {}, expected an image", image.is_null ? "null" : "without bytes")};
    }

    Failure of_rows(Failure failure) const {
        failure.message = fmt::format("{}: {}", rows_, failure.message);
        return failure;
    }

    std::unique_ptr<Table> table_;
    std::unique_ptr<ImageDecoder> decoder_;
    std::string rows_;
    std::string camera_;
    std::uint64_t length_;
    std::uint64_t stride_;
    std::uint64_t row_ = 0;  ///< next row of the episode
    std::vector<Table::Cell> cells_;
};

/// Checks the columns of a camera.
std::optional<std::string> refused(const std::string& camera,
                                   const std::vector<Table::Column>& columns) {
    const Table::Column& bytes = columns[0];
    const Table::Column& path = columns[1];
    const std::string expected =
        fmt::format("expected {} as a struct of bytes and path", in_quotes(camera));
    if (!bytes.exists)
        return fmt::format("has no column {}, {}", in_quotes(camera + ".bytes"), expected);
    if (!bytes.is_text || bytes.is_list)
        return fmt::format("column {} does not hold bytes, {}", in_quotes(camera + ".bytes"),
                           expected);
    if (path.exists && (!path.is_text || path.is_list))
        return fmt::format("column {} does not hold text, {}", in_quotes(camera + ".path"),
                           expected);
    return std::nullopt;
}

/// Opens the images of a camera. Failures name the file of the rows: E0851, or E1009 for an image,
/// with its row in the episode.
diag::Result<std::unique_ptr<FrameSource>> open_stored_images(const Dataset& set,
                                                              const DatasetEpisode& episode,
                                                              const std::string& camera,
                                                              std::uint64_t stride) {
    const auto of_rows = [&](Code code, const std::string& why) {
        return Failure{code, fmt::format("{}: {}", episode.rows, why)};
    };
    auto table = Table::open(set.path_of(episode.rows), {camera + ".bytes", camera + ".path"},
                             "episode_index", episode.index);
    if (!table) return of_rows(table.failure().code, table.failure().message);
    if (const auto why = refused(camera, (*table)->columns()))
        return of_rows(Code::unreadable_parquet, *why);
    auto decoder = ImageDecoder::start();
    if (!decoder) return decoder.failure();
    return std::unique_ptr<FrameSource>(std::make_unique<StoredImages>(
        std::move(*table), std::move(*decoder), episode, camera, stride));
}

/// The frames of a video, which must be as many as there are steps.
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
