#include "embed/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>
#include <string_view>
#include <utility>

#include "artifacts/embedded.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "data/text/text.hpp"
#include "data/traces/csv.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/datasets/trace.hpp"
#include "recordings/hdf5/hdf5.hpp"

namespace etlc::embed {

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;

diag::Result<std::map<std::string, std::string>> cameras_of(const recordings::Dataset& set,
                                                            const Search& search) {
    std::map<std::string, std::string> cameras;
    for (const std::string& input : search.inputs) {
        auto camera = recordings::camera_of(set, search.camera(input));
        if (!camera) return camera.failure();
        cameras[input] = *camera;
    }
    return cameras;
}

/// The metadata place the frames in a video or in the rows.
Origin origin_of_clip(const recordings::SoundEpisode& sound, const std::string& camera,
                      std::uint64_t stride) {
    const recordings::Dataset& set = *sound.set;
    Origin origin;
    origin.choice = fmt::format("{} {} {}", sound.episode->index, stride, camera);
    const auto clip = sound.episode->clips.find(camera);
    if (clip != sound.episode->clips.end()) origin.video = set.path_of(clip->second.path);
    std::error_code error;
    fs::recursive_directory_iterator it(set.path_of("meta"),
                                        fs::directory_options::follow_directory_symlink, error);
    for (; !error && it != fs::recursive_directory_iterator(); it.increment(error))
        if (it->is_regular_file(error)) origin.files.push_back(it->path().string());
    if (error) origin.files.push_back(set.path_of("meta"));  // a folder has no hash
    std::sort(origin.files.begin(), origin.files.end());
    origin.files.push_back(set.path_of(sound.episode->rows));
    return origin;
}

Recording recording_of(const recordings::SoundEpisode& sound, std::uint64_t stride,
                       const std::map<std::string, std::string>& cameras) {
    const std::string& folder = sound.set->folder();
    Recording recording;
    recording.path = recordings::episode_path(folder, sound.episode->index);
    recording.episode =
        fmt::format("{}-{:06}", recordings::name_of_folder(folder), sound.episode->index);
    std::set<std::string> different;
    for (const auto& [input, camera] : cameras) different.insert(camera);
    recording.has_one_camera = different.size() < 2;
    recording.open = [sound, stride, cameras](const std::string& input) {
        return recordings::open_clip(*sound.set, *sound.episode, cameras.at(input), stride);
    };
    recording.origin = [sound, stride, cameras](const std::string& input) {
        return origin_of_clip(sound, cameras.at(input), stride);
    };
    recording.columns = recording.path;
    recording.stride = stride;
    recording.tasks = sound.episode->tasks;
    return recording;
}

diag::Result<std::vector<Recording>> recordings_in_dataset(const data::DatasetPath& path,
                                                           const Search& search, diag::Sink& sink) {
    const auto paths = recordings::find_dataset_episodes(path, sink);
    if (!paths) return paths.failure();
    const auto set = recordings::Dataset::known(path.folder);
    if (!set) return set.failure();
    const auto stride = recordings::rows_a_step(**set, search.rate);
    if (!stride) return stride.failure();
    const auto cameras = cameras_of(**set, search);
    if (!cameras) return cameras.failure();
    std::vector<Recording> recordings;
    for (const std::string& episode : *paths) {
        const auto sound = recordings::find_episode(episode);
        if (!sound) return sound.failure();
        std::string lack;
        for (const auto& [input, camera] : *cameras)
            if (lack.empty()) lack = recordings::camera_lack(*sound->set, *sound->episode, camera);
        if (lack.empty())
            recordings.push_back(recording_of(*sound, *stride, *cameras));
        else
            sink.report({Code::dataset_lacks,
                         fmt::format("episode {} is left out: {}", sound->episode->index, lack),
                         {},
                         path.folder});
    }
    if (recordings.empty())
        return diag::Failure{Code::no_such_episode, "has no episode that is whole"};
    return recordings;
}

/// Returns whether a path is that of arrays: .npz, .h5, .hdf5 or FILE.h5:GROUP.
bool is_arrays(const std::string& path) {
    const std::string file = data::trace_file(path);
    return file.ends_with(".npz") || data::is_hdf5(file);
}

diag::Result<std::vector<Recording>> recordings_in_arrays(const std::string& path,
                                                          const Search& search) {
    const std::string file = data::trace_file(path);
    std::vector<std::string> groups = {path.substr(std::min(file.size() + 1, path.size()))};
    if (groups[0].empty() && data::is_hdf5(file) && !search.groups.empty()) {
        auto found = recordings::list_hdf5(file, search.groups);
        if (!found) return found.failure();
        groups = std::move(*found);
    }
    std::vector<Recording> recordings;
    for (const std::string& group : groups) {
        Recording recording;
        recording.path = group.empty() ? file : file + ":" + group;
        recording.episode = fs::path(file).stem().string();
        if (!group.empty()) recording.episode += "-" + fs::path(group).filename().string();
        std::set<std::string> different;
        for (const std::string& input : search.inputs) different.insert(search.camera(input));
        recording.has_one_camera = different.size() < 2;
        recording.open = [whole = recording.path, search](const std::string& input) {
            return recordings::open_image_array(whole, search.camera(input));
        };
        recording.origin = [file, group, search](const std::string& input) {
            return Origin{{}, {file}, group + "\n" + search.camera(input)};
        };
        recording.columns = recording.path;
        recordings.push_back(std::move(recording));
    }
    return recordings;
}

constexpr std::string_view kExpected =
    "expected a video, a folder of images, a data set, an .npz or .h5 file of images, or a folder "
    "or pattern of these";

/// Returns "drives/ep3.csv" for "drives/ep3.mp4" or the folder "drives/ep3".
std::string beside(const fs::path& folder, const std::string& name) {
    const fs::path path = folder / (name + ".csv");
    std::error_code error;
    return fs::exists(path, error) ? path.string() : "";
}

Recording video(const std::string& path, double rate) {
    const fs::path file = path;
    const std::string name = file.stem().string();
    return {
        path,
        name,
        true,
        [path, rate](const std::string&) { return recordings::open_video(path, {.rate = rate}); },
        [path, rate](const std::string&) {
            return Origin{path, {}, fmt::format("{} steps a second", rate)};
        },
        beside(file.parent_path(), name),
        {path}};
}

Recording images(const std::string& folder, std::vector<std::string> paths) {
    fs::path place = fs::path(folder).lexically_normal();
    if (!place.has_filename()) place = place.parent_path();  // of "drives/ep3/"
    const std::string name = place.filename().string();
    return {folder,
            name,
            true,
            [paths](const std::string&) { return recordings::open_images(paths); },
            [paths](const std::string&) {
                return Origin{{}, paths, "images"};
            },
            beside(place.parent_path(), name),
            std::move(paths)};
}

std::vector<std::string> sorted_entries(const std::string& folder) {
    std::vector<std::string> paths;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        paths.push_back(it->path().string());
    std::sort(paths.begin(), paths.end());
    return paths;
}

class Finder {
public:
    Finder(const Search& search, diag::Sink& sink) : search_(search), sink_(sink) {}

    diag::Result<std::vector<Recording>> at(const std::string& path) {
        std::error_code error;
        if (const auto set = data::dataset_path(path))
            return recordings_in_dataset(*set, search_, sink_);
        if (fs::is_directory(path, error)) {
            auto found = in_folder(path, true);
            if (!found || !found->empty()) return found;
            return Failure{Code::unreadable_video,
                           fmt::format("holds no recording, {}", kExpected)};
        }
        if (is_arrays(path) && !data::why_unreadable(data::trace_file(path)))
            return recordings_in_arrays(path, search_);
        const auto why = data::why_unreadable(path);
        if (!why) return std::vector<Recording>{video(path, search_.rate)};
        if (fs::exists(path, error)) return Failure{Code::unreadable_video, *why};
        return matching(path);
    }

private:
    /// Finds the recordings in a folder: its images as one recording; else the videos, data sets
    /// and folders of images in it; else its archives of arrays.
    diag::Result<std::vector<Recording>> in_folder(const std::string& folder, bool below) {
        const std::vector<std::string> entries = sorted_entries(folder);
        std::vector<std::string> frames;
        std::copy_if(entries.begin(), entries.end(), std::back_inserter(frames), data::is_image);
        if (!frames.empty()) return std::vector<Recording>{images(folder, std::move(frames))};
        std::vector<Recording> found;
        std::error_code error;
        for (const std::string& path : entries) {
            if (recordings::is_video(path)) found.push_back(video(path, search_.rate));
            if (!below || !fs::is_directory(path, error)) continue;
            const auto set = data::dataset_path(path);
            auto inside =
                set ? recordings_in_dataset(*set, search_, sink_) : in_folder(path, false);
            if (!inside) return inside;
            add(found, std::move(*inside));
        }
        for (const std::string& path : entries) {
            if (!found.empty() && found.back().columns.empty()) break;
            if (!is_arrays(path)) continue;
            auto inside = recordings_in_arrays(path, search_);
            if (!inside) return inside;
            add(found, std::move(*inside));
        }
        return found;
    }

    diag::Result<std::vector<Recording>> matching(const std::string& pattern) {
        std::vector<Recording> all;
        const auto matches = data::paths_matching(pattern);
        for (const std::string& match : matches.value_or(std::vector<std::string>{}))
            if (auto found = at(match)) add(all, std::move(*found));
        if (!all.empty()) return all;
        return Failure{Code::unreadable_video,
                       recordings::with_dataset_meant(
                           fmt::format("no such recording, {}", kExpected), pattern)};
    }

    static void add(std::vector<Recording>& all, std::vector<Recording> more) {
        for (Recording& recording : more) all.push_back(std::move(recording));
    }

    const Search& search_;
    diag::Sink& sink_;
};

}  // namespace

std::string Search::camera(const std::string& input) const {
    const auto own = cameras.find(input);
    const auto any = own != cameras.end() ? own : cameras.find("");
    return any == cameras.end() ? "" : any->second;
}

std::vector<Recording> find_recordings(const Search& search, diag::Sink& sink) {
    Finder finder(search, sink);
    std::vector<Recording> recordings;
    for (const std::string& argument : search.arguments) {
        auto found = finder.at(argument);
        if (!found) {
            sink.report(data::in_file(found.failure(), argument));
            continue;
        }
        for (Recording& recording : *found) recordings.push_back(std::move(recording));
    }
    return recordings;
}

namespace {

using data::Channel;

/// Returns how a column is read, by its name.
diag::Result<Channel> channel_of(const check::Model& model, const data::ElementName& column) {
    Channel channel{column.array, column.element ? Channel::Kind::vector : Channel::Kind::scalar, 1,
                    false};
    if (column.array.starts_with("truth.")) channel.kind = Channel::Kind::boolean;
    for (const check::Input& input : model.inputs) {
        if (input.name != column.array) continue;
        if (input.encoder != check::kNone)
            return Failure{
                Code::no_such_channel,
                fmt::format("has a column {}, which '{}' makes of the frames",
                            data::in_quotes(column.array), model.encoders[input.encoder].name),
                1, 1};
        if (input.type == check::InputType::boolean) channel.kind = Channel::Kind::boolean;
    }
    return channel;
}

diag::Result<std::vector<Channel>> channels_of(const check::Model& model, const std::string& path) {
    auto source = data::open_file(path);
    if (!source) return source.failure();
    data::CsvReader header(std::move(*source));
    const auto read = header.next();
    if (!read) return read.failure();
    std::vector<Channel> channels;
    for (std::size_t i = 0; *read && i < header.cells(); ++i) {
        const data::ElementName column = data::element_name(header.cell(i));
        const auto same = [&](const Channel& other) { return other.name == column.array; };
        const auto known = std::find_if(channels.begin(), channels.end(), same);
        if (known != channels.end()) {
            known->width = std::max(known->width, column.element.value_or(0) + 1);
            continue;
        }
        auto channel = channel_of(model, column);
        if (!channel) return channel.failure();
        channel->width = column.element.value_or(0) + 1;
        channels.push_back(std::move(*channel));
    }
    constexpr std::uint32_t kMostElements = 1U << 20U;  // no row of a file has more cells
    for (const Channel& channel : channels)
        if (channel.width > kMostElements)
            return Failure{Code::trace_shape,
                           fmt::format("has a column {}[{}], expected at most {} elements",
                                       channel.name, channel.width - 1, kMostElements),
                           1, 1};
    return channels;
}

/// Reads every `stride`-th step of a trace.
diag::Result<std::vector<Array>> read_arrays(data::Trace& trace,
                                             const std::vector<Channel>& channels,
                                             std::uint64_t stride) {
    std::vector<Array> arrays;
    for (const Channel& channel : channels)
        arrays.push_back({channel.name, channel.width, {}, channel.kind == Channel::Kind::vector});
    data::Sample sample;
    for (std::uint64_t step = 0;; ++step) {
        const auto more = trace.next(sample);
        if (!more) return more.failure();
        if (!*more) return arrays;
        if (step % stride != 0) continue;
        for (std::size_t c = 0; c < arrays.size(); ++c)
            for (const double value : sample.values[c])
                arrays[c].values.push_back(sample.present[c]
                                               ? static_cast<float>(value)
                                               : std::numeric_limits<float>::quiet_NaN());
    }
}

}  // namespace

diag::Result<std::vector<Array>> arrays_beside(const check::Model& model, const std::string& path) {
    const auto channels = channels_of(model, path);
    if (!channels) return channels.failure();
    const auto trace = recordings::open_trace(path, *channels);
    if (!trace) return trace.failure();
    return read_arrays(**trace, *channels, 1);
}

diag::Result<std::vector<Array>> arrays_in(const check::Model& model, const Recording& recording,
                                           const recordings::NamesInFile& names) {
    std::vector<Channel> channels;
    for (const check::Input& input : model.inputs) {
        if (input.encoder != check::kNone) continue;
        Channel channel{input.name, Channel::Kind::scalar, 1, false};
        if (input.type == check::InputType::boolean) channel.kind = Channel::Kind::boolean;
        if (input.is_embedding()) {
            channel.kind = Channel::Kind::vector;
            channel.width = input.dimension;
        }
        channels.push_back(std::move(channel));
    }
    for (const auto& [name, in_file] : names)
        if (name.starts_with("truth."))
            channels.push_back({name, Channel::Kind::boolean, 1, false});
    if (channels.empty()) return std::vector<Array>{};
    const auto trace =
        recordings::open_trace(recording.columns, recordings::renamed(channels, names));
    if (!trace) return trace.failure();
    return read_arrays(**trace, channels, recording.stride);
}

namespace {

std::string hash_of(const std::string& path) {
    const auto hash = data::hash_of_file(path, diag::Code::unreadable_data_file);
    return hash ? *hash : "";
}

/// Returns whether a video is a text, which may be a playlist: its frames are in other files.
bool may_name_others(const std::string& video) {
    return data::ends_of_file(video).find('\0') == std::string::npos;
}

/// Hashes the files that a command names: the program, its script, its weights.
std::string hashes_of_words(const std::string& command) {
    constexpr std::string_view kBetweenWords = " \t\n\"'`;&|<>()=";
    std::string hashes;
    for (std::size_t begin = 0; begin < command.size();) {
        const std::size_t end =
            std::min(command.find_first_of(kBetweenWords, begin), command.size());
        if (end > begin) hashes += hash_of(command.substr(begin, end - begin)) + "\n";
        begin = end + 1;
    }
    return hashes;
}

}  // namespace

Earlier::Earlier(const Running& running, const std::string& version)
    : made_by_(version + "\n" + running.command + "\n" +
               (running.command.empty() ? hash_of(running.onnxruntime)
                                        : hashes_of_words(running.command)) +
               "\n") {}

std::string Earlier::hash(const std::string& path, bool is_shared) {
    if (!is_shared) return hash_of(path);
    std::string& known = shared_[path];
    if (known.empty()) known = hash_of(path);
    return known;
}

std::string Earlier::origin(const Recording& recording, const std::string& input,
                            const std::string& encoder) {
    const Origin from = recording.origin(input);
    if (!from.video.empty() && may_name_others(from.video)) return {};
    std::string text = made_by_ + encoder + "\n" + from.choice + "\n";
    const auto add = [&](const std::string& path) {
        const std::string found = hash(path, recording.files.empty());
        text += found + "\n";
        return !found.empty();
    };
    if (!from.video.empty() && !add(from.video)) return {};
    for (const std::string& path : from.files)
        if (!add(path)) return {};
    return text;
}

std::string bound(const std::string& origin, std::uint32_t dimension,
                  const std::vector<float>& rows) {
    const std::string content = data::content_hash({rows.size() / dimension, dimension}, rows);
    return data::hash_text(data::xxh64(origin + content));
}

std::optional<std::vector<float>> embeddings_in(const std::string& episode,
                                                const std::string& input, std::uint32_t dimension,
                                                const std::string& origin) {
    if (origin.empty()) return std::nullopt;
    const embedded::Origins origins = embedded::read_origins(episode);
    const auto known = origins.find(input);
    if (known == origins.end()) return std::nullopt;
    const auto array = data::read_npz(episode, input);
    if (!array || array->element != data::Element::f32 || array->shape.size() != 2 ||
        array->shape[1] != dimension)
        return std::nullopt;
    std::vector<float> rows(array->values.begin(), array->values.end());
    if (bound(origin, dimension, rows) != known->second) return std::nullopt;
    return rows;
}

}  // namespace etlc::embed
