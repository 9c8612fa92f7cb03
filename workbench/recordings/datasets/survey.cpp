// Compares the rows and videos of a data set with its metadata.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::recordings {

using namespace data;

namespace {

/// The largest distance of a row from its time, in steps, and of an episode from a frame of its
/// video, in frames: more than what float32 rounds off.
constexpr double kTolerance = 0.1;

/// Says how a row contradicts its place in the episode; empty: it does not.
std::string fault_of_row(std::uint64_t row, const std::vector<Table::Column>& columns,
                         const std::vector<Table::Cell>& cells, double fps) {
    const Table::Cell& frame = cells[1];
    const Table::Cell& time = cells[2];
    const auto place = static_cast<double>(row);
    if (columns[1].exists && (frame.is_null || frame.numbers[0] != place))
        return fmt::format("row {} has the frame_index {}", row,
                           frame.is_null ? "null" : fmt::format("{}", frame.numbers[0]));
    const double time_of_row =
        time.is_null ? std::numeric_limits<double>::quiet_NaN() : time.numbers[0];
    if (columns[2].exists && !(std::abs(time_of_row * fps - place) <= kTolerance))
        return fmt::format("row {} is at {} s, expected it at {:.6g} s", row,
                           time.is_null ? "null" : fmt::format("{:.6g}", time_of_row), place / fps);
    return "";
}

}  // namespace

void Dataset::survey(const std::string& rows) {
    std::map<std::uint64_t, Found>& found = found_[rows];
    const auto give_up = [&](const std::string& why) {
        for (const DatasetEpisode& episode : episodes_)
            if (episode.rows == rows)
                found[episode.index] = {episode.length, fmt::format("{}: {}", rows, why)};
    };
    auto table = Table::open(path_of(rows), {"episode_index", "frame_index", "timestamp"});
    if (!table) return give_up(table.failure().message);
    const auto& columns = (*table)->columns();
    if (!columns[0].exists) return give_up("has no column 'episode_index'");
    for (const Table::Column& column : columns)
        if (column.is_text || column.is_list)
            return give_up(
                "has an episode_index, frame_index or timestamp that is no number a row");
    std::vector<Table::Cell> cells;
    double last = -1;
    for (;;) {
        const auto more = (*table)->next(cells);
        if (!more) return give_up(more.failure().message);
        if (!*more) break;
        const double index = cells[0].is_null ? -1 : cells[0].numbers[0];
        if (!(index >= 0) || index > 1e15 || index != std::floor(index))
            return give_up("has a row of no episode");
        Found& one = found[static_cast<std::uint64_t>(index)];
        if (one.lack.empty() && one.rows > 0 && last != index)
            one.lack = "its rows are apart from each other";
        if (one.lack.empty()) one.lack = fault_of_row(one.rows, columns, cells, fps_);
        ++one.rows;
        last = index;
    }
    for (const DatasetEpisode& episode : episodes_) {
        if (episode.rows != rows) continue;
        Found& one = found[episode.index];
        if (one.rows != episode.length)
            one.lack = fmt::format("{} has {} of it, the metadata say {}", rows,
                                   diag::counted(one.rows, "row"), episode.length);
        else if (!one.lack.empty())
            one.lack = fmt::format("{}: {}", rows, one.lack);
        else if (one.rows == 0)
            one.lack = "it has no row";
    }
}

const Dataset::Found& Dataset::found(const DatasetEpisode& episode) {
    if (found_.find(episode.rows) == found_.end()) survey(episode.rows);
    return found_[episode.rows][episode.index];
}

std::string Dataset::lack(const DatasetEpisode& episode) {
    const std::lock_guard guard(lock_);
    return found(episode).lack;
}

namespace {

/// Beyond this distance an episode is at the place of another frame.
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

/// Says why a part does not begin where the previous one ends; empty: it does. `before`: null for
/// the first part; `away`: frames between its begin and the end of the rows of all earlier parts.
std::string why_misplaced(const VideoPart* before, const VideoPart& part, double away, double fps) {
    const bool exists = std::abs(away) < kFrame;
    if (before == nullptr)
        return exists ? ""
                      : fmt::format("{} is its first, expected one that begins at 0 s",
                                    in_words(part, fps));
    const std::string both = fmt::format("{} and {}", in_words(*before, fps), in_words(part, fps));
    if (!exists) return both + " leave a hole between them";
    if (before->episode->index > part.episode->index)
        return both + " are not in the order of their numbers";
    return "";
}

/// Says why two parts overlap; empty: they do not. `end`: of the earlier one, in frames.
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
        // The length of an episode that contradicts itself is that of its rows.
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

}  // namespace etlc::recordings
