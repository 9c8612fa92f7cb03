#include "embed/sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "data/datasets/trace.hpp"
#include "data/hdf5/hdf5.hpp"
#include "data/recordings/image_arrays.hpp"
#include "data/recordings/open.hpp"

namespace etlc::embed {

namespace {

namespace fs = std::filesystem;
using diag::Code;

std::string name_of_folder(const std::string& folder) {
    std::error_code error;
    const std::string name = fs::path(folder).lexically_normal().filename().string();
    if (!name.empty() && name != "." && name != "..") return name;
    return fs::canonical(folder, error).filename().string();
}

/// The cameras of the inputs, by input.
diag::Result<std::map<std::string, std::string>> cameras_of(const data::Dataset& set,
                                                            const Search& search) {
    std::map<std::string, std::string> cameras;
    for (const std::string& input : search.inputs) {
        auto camera = data::camera_of(set, search.camera(input));
        if (!camera) return camera.failure();
        cameras[input] = *camera;
    }
    return cameras;
}

Recording recording_of(const data::SoundEpisode& sound, std::uint64_t stride,
                       const std::map<std::string, std::string>& cameras) {
    const std::string& folder = sound.set->folder();
    Recording recording;
    recording.path = data::episode_path(folder, sound.episode->index);
    recording.episode = fmt::format("{}-{:06}", name_of_folder(folder), sound.episode->index);
    std::set<std::string> different;
    for (const auto& [input, camera] : cameras) different.insert(camera);
    recording.has_one_camera = different.size() < 2;
    recording.open = [sound, stride, cameras](const std::string& input) {
        return data::open_clip(*sound.set, *sound.episode, cameras.at(input), stride);
    };
    recording.columns = recording.path;
    recording.stride = stride;
    recording.tasks = sound.episode->tasks;
    return recording;
}

}  // namespace

diag::Result<std::vector<Recording>> recordings_in_dataset(const data::DatasetPath& path,
                                                           const Search& search, diag::Sink& sink) {
    const auto paths = data::find_dataset_episodes(path, sink);
    if (!paths) return paths.failure();
    const auto set = data::Dataset::known(path.folder);
    if (!set) return set.failure();
    const auto stride = data::rows_a_step(**set, search.rate);
    if (!stride) return stride.failure();
    const auto cameras = cameras_of(**set, search);
    if (!cameras) return cameras.failure();
    std::vector<Recording> recordings;
    for (const std::string& episode : *paths) {
        const auto sound = data::find_episode(episode);
        if (!sound) return sound.failure();
        std::string lack;
        for (const auto& [input, camera] : *cameras)
            if (lack.empty()) lack = data::camera_lack(*sound->set, *sound->episode, camera);
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

bool is_arrays(const std::string& path) {
    const std::string file = data::trace_file(path);
    return file.ends_with(".npz") || data::is_hdf5(file);
}

diag::Result<std::vector<Recording>> recordings_in_arrays(const std::string& path,
                                                          const Search& search) {
    const std::string file = data::trace_file(path);
    std::vector<std::string> groups = {path.substr(std::min(file.size() + 1, path.size()))};
    if (groups[0].empty() && data::is_hdf5(file) && !search.groups.empty()) {
        auto found = data::list_hdf5(file, search.groups);
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
            return data::open_image_array(whole, search.camera(input));
        };
        recording.columns = recording.path;
        recordings.push_back(std::move(recording));
    }
    return recordings;
}

}  // namespace etlc::embed
