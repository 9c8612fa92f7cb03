#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "data/text/subtask_name.hpp"
#include "data/text/text.hpp"
#include "data/traces/trace_formats.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/datasets/subtasks.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/frames/frames.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::recordings {

using namespace data;

namespace {

using diag::Code;
using diag::Failure;

/// Returns the column of a channel; for "action[3]" also the place in it.
ElementName wanted_of(const Channel& channel) {
    if (channel.kind == Channel::Kind::vector) return {channel.name, {}};
    return element_name(channel.name);
}

/// The rows of all channels, which read them in step.
class JointCells {
public:
    JointCells(std::unique_ptr<Table> table, std::uint64_t steps)
        : table_(std::move(table)), steps_(steps) {}

    /// Returns a cell of row `step`, which is the current or the next one.
    diag::Result<const Table::Cell*> cell(std::uint64_t step, std::size_t column) {
        if (step < taken_) return &cells_[column];
        const auto more = table_->next(cells_);
        if (!more) return more.failure();
        if (!*more) return changed();
        if (++taken_ < steps_) return &cells_[column];
        std::vector<Table::Cell> behind;
        const auto end = table_->next(behind);
        if (!end) return end.failure();
        if (*end) return changed();
        return &cells_[column];
    }

private:
    static Failure changed() {
        return {Code::unreadable_dataset, "has other rows than before: it has changed meanwhile"};
    }

    std::unique_ptr<Table> table_;
    std::uint64_t steps_;
    std::uint64_t taken_ = 0;
    std::vector<Table::Cell> cells_;
};

class CellRows final : public Rows {
public:
    CellRows(std::shared_ptr<JointCells> joint, std::size_t column, ElementName wanted,
             std::uint32_t width)
        : joint_(std::move(joint)), column_(column), wanted_(std::move(wanted)), row_(width) {}

    diag::Result<const double*> next() override {
        const auto cell = joint_->cell(step_++, column_);
        if (!cell) return cell.failure();
        if ((*cell)->is_null) {
            std::fill(row_.begin(), row_.end(), std::numeric_limits<double>::quiet_NaN());
            return row_.data();
        }
        const std::vector<double>& numbers = (*cell)->numbers;
        if (wanted_.element && *wanted_.element < numbers.size()) {
            row_[0] = numbers[*wanted_.element];
            return row_.data();
        }
        if (wanted_.element || numbers.size() != row_.size())
            return Failure{
                Code::trace_shape,
                fmt::format("has {} in row {} of the episode, expected {}",
                            diag::counted(numbers.size(), "element"), step_ - 1,
                            wanted_.element ? fmt::format("more than {}", *wanted_.element)
                                            : std::to_string(row_.size()))};
        std::copy(numbers.begin(), numbers.end(), row_.begin());
        return row_.data();
    }

private:
    std::shared_ptr<JointCells> joint_;
    std::size_t column_;
    ElementName wanted_;
    std::vector<double> row_;
    std::uint64_t step_ = 0;
};

/// Whether each row shows a subtask.
class SubtaskRows final : public Rows {
public:
    SubtaskRows(Subtasks subtasks, std::string_view name)
        : subtasks_(std::move(subtasks)), name_(name) {}

    diag::Result<const double*> next() override {
        const auto shows = subtasks_.shows(row_++, name_);
        value_ = shows ? static_cast<double>(*shows) : std::numeric_limits<double>::quiet_NaN();
        return &value_;
    }

private:
    Subtasks subtasks_;
    std::string name_;
    std::size_t row_ = 0;
    double value_ = 0;
};

/// Refuses a column that is missing, or does not hold numbers.
std::optional<Failure> refused(const Dataset& set, const Channel& channel,
                               const ElementName& wanted, const Table::Column& column) {
    std::vector<std::string> columns;
    for (const Feature& feature : set.features()) {
        const bool is_picture = feature.type == "video" || feature.type == "image";
        if (is_picture && feature.name == wanted.array)
            return Failure{Code::no_such_channel,
                           fmt::format("{} is a camera; `etlc embed` makes embeddings of it",
                                       in_quotes(wanted.array))};
        if (!is_picture) columns.push_back(feature.name);
    }
    if (!column.exists) {
        return Failure{Code::no_such_channel,
                       fmt::format("no column {}{}; there are {}", in_quotes(wanted.array),
                                   suggestion(wanted.array, columns), listed(columns))};
    }
    if (column.is_text)
        return Failure{Code::trace_elements, fmt::format("column {} holds text, expected numbers",
                                                         in_quotes(wanted.array))};
    if (column.is_bool && channel.kind != Channel::Kind::boolean)
        return Failure{Code::trace_elements,
                       fmt::format("column {} has bool elements, expected numbers: the input is "
                                   "no bool",
                                   in_quotes(wanted.array))};
    return std::nullopt;
}

std::optional<Failure> refuse_empty(const DatasetPath& path) {
    if (path.first < path.end) return std::nullopt;
    return Failure{Code::no_such_episode,
                   fmt::format("'{}:{}' ends before it begins: {} are the episodes 0 to 49",
                               path.first, path.end, in_quotes(path.folder + ":0:50"))};
}

}  // namespace

diag::Result<SoundEpisode> find_episode(const std::string& path) {
    const auto which = dataset_path(path);
    if (!which) return Failure{Code::unreadable_dataset, "is no episode of a data set"};
    auto set = Dataset::known(which->folder);
    if (!set) return set.failure();
    if (auto failure = refuse_empty(*which)) return *failure;
    const bool is_one = which->end == which->first + 1;
    if (!is_one && (*set)->episodes().size() != 1)
        return Failure{
            Code::no_such_episode,
            fmt::format("is a data set of {}: name one, {}",
                        diag::counted((*set)->episodes().size(), "episode"),
                        in_quotes(episode_path(which->folder, (*set)->episodes()[0].index)))};
    const DatasetEpisode* const episode =
        is_one ? (*set)->episode(which->first) : &(*set)->episodes()[0];
    if (episode == nullptr)
        return Failure{
            Code::no_such_episode,
            fmt::format("is not an episode of the data set; it has {}, {} to {}",
                        diag::counted((*set)->episodes().size(), "episode"),
                        (*set)->episodes().front().index, (*set)->episodes().back().index)};
    if (const std::string why = (*set)->lack(*episode); !why.empty())
        return Failure{Code::no_such_episode, why};
    return SoundEpisode{*set, episode};
}

diag::Result<std::unique_ptr<Trace>> open_dataset_trace(const std::string& path,
                                                        const std::vector<Channel>& channels) {
    const auto found = find_episode(path);
    if (!found) return found.failure();
    const DatasetEpisode& episode = *found->episode;
    std::vector<ElementName> wanted;
    std::vector<std::string> names;
    for (const Channel& channel : channels) {
        wanted.push_back(wanted_of(channel));
        names.push_back(wanted.back().array);
    }
    auto table =
        Table::open(found->set->path_of(episode.rows), names, "episode_index", episode.index);
    if (!table) return in_part(episode.rows, table.failure());
    std::vector<bool> there;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        if (there.emplace_back(false); subtask_name(channels[c].name)) continue;
        const Table::Column& column = (*table)->columns()[c];
        there[c] = column.exists || !channels[c].optional;
        if (!there[c]) continue;
        if (auto failure = refused(*found->set, channels[c], wanted[c], column)) return *failure;
    }
    const auto joint = std::make_shared<JointCells>(std::move(*table), episode.length);
    std::vector<Feed> feeds;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        feeds.push_back({channels[c], episode.length, nullptr});
        if (const auto asked = subtask_name(channels[c].name)) {
            auto subtasks = read_subtasks(path, asked->word);
            if (!subtasks) return subtasks.failure();
            if (!subtasks->source.empty())
                feeds[c].rows = std::make_unique<SubtaskRows>(std::move(*subtasks), asked->text);
            else if (!channels[c].optional)
                return Failure{Code::no_such_channel,
                               fmt::format("has no {}; {} compares it with a text",
                                           in_quotes(asked->word), channels[c].name)};
        }
        if (there[c])
            feeds[c].rows = std::make_unique<CellRows>(joint, c, wanted[c], channels[c].width);
    }
    return open_array_trace(std::move(feeds));
}

diag::Result<std::uint64_t> rows_a_step(const Dataset& set, double rate) {
    constexpr double kRateTolerance = 0.005;  // as for videos: 29.97 frames a second are 30
    if (rate == 0) return std::uint64_t{1};
    const double rows = set.fps() / rate;
    const double nearest = std::max(1.0, std::round(rows));
    if (std::abs(rows / nearest - 1) > kRateTolerance)
        return Failure{Code::dataset_out_of_step,
                       fmt::format("has {:.6g} rows a second, expected a multiple of the {:.6g} "
                                   "steps of the spec",
                                   set.fps(), rate)};
    return static_cast<std::uint64_t>(nearest);
}

diag::Result<std::vector<std::string>> find_dataset_episodes(const DatasetPath& path,
                                                             diag::Sink& sink) {
    const auto set = Dataset::known(path.folder);
    if (!set) return set.failure();
    if (auto failure = refuse_empty(path)) return *failure;
    const auto warn = [&](const std::string& message) {
        diag::Diagnostic found{Code::dataset_lacks, message, {}, path.folder};
        sink.report(std::move(found));
    };
    for (const std::string& contradiction : (*set)->contradictions()) warn(contradiction);
    std::vector<std::string> paths;
    for (const DatasetEpisode& episode : (*set)->episodes()) {
        if (episode.index < path.first || episode.index >= path.end) continue;
        const std::string why = (*set)->lack(episode);
        if (why.empty()) paths.push_back(episode_path(path.folder, episode.index));
        if (!why.empty()) warn(fmt::format("episode {} is left out: {}", episode.index, why));
    }
    if (paths.empty())
        return Failure{
            Code::no_such_episode,
            fmt::format("has none of these episodes as its metadata say; it has {}, {} "
                        "to {}",
                        diag::counted((*set)->episodes().size(), "episode"),
                        (*set)->episodes().front().index, (*set)->episodes().back().index)};
    return paths;
}

std::optional<Failure> check_rate(const std::string& path, double step_seconds) {
    if (step_seconds == 0) return std::nullopt;
    const auto which = dataset_path(path);
    if (!which) return std::nullopt;
    const auto set = Dataset::known(which->folder);
    if (!set) return set.failure();
    const auto stride = rows_a_step(**set, 1 / step_seconds);
    if (!stride) return stride.failure();
    if (*stride == 1) return std::nullopt;
    return Failure{
        Code::dataset_out_of_step,
        fmt::format("has {:.6g} rows a second, the spec {:.6g} steps; `etlc embed` makes "
                    "episodes of one row in {}",
                    (*set)->fps(), 1 / step_seconds, *stride)};
}

namespace {

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
            if (!more) return in_part(rows_, more.failure());
            if (*more != (row_ < length_))
                return in_part(rows_, {Code::unreadable_dataset,
                                       "has other rows than before: it has changed meanwhile"});
            if (!*more) return false;
            if (row_ % stride_ == 0) break;
            ++row_;
        }
        if (auto failure = decode(frame))
            return in_part(
                rows_, in_part(fmt::format("row {} of the episode: {}", row_, camera_), *failure));
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
    auto table = Table::open(set.path_of(episode.rows), {camera + ".bytes", camera + ".path"},
                             "episode_index", episode.index);
    if (!table) return in_part(episode.rows, table.failure());
    if (const auto why = refused(camera, (*table)->columns()))
        return in_part(episode.rows, {Code::unreadable_parquet, *why});
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
        if (!more) return in_part(video_, more.failure());
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

}  // namespace etlc::recordings
