#include "embed/recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "data/files/file.hpp"
#include "data/files/paths.hpp"
#include "data/frames/images.hpp"

namespace etlc::embed {

namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;

constexpr std::string_view kExpected =
    "expected a video, a folder of images, or a folder or pattern of these";

/// "drives/ep3.csv" of "drives/ep3.mp4", or of the folder "drives/ep3".
std::string beside(const fs::path& folder, const std::string& name) {
    const fs::path path = folder / (name + ".csv");
    std::error_code error;
    return fs::exists(path, error) ? path.string() : "";
}

Recording video(const std::string& path, double rate) {
    const fs::path file = path;
    const std::string name = file.stem().string();
    return {path,
            name,
            true,
            [path, rate](const std::string&) { return data::open_video(path, {.rate = rate}); },
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
            [paths](const std::string&) { return data::open_images(paths); },
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

/// Of a folder its images as one recording; else the videos and folders of images in it.
std::vector<Recording> in_folder(const std::string& folder, double rate, bool below) {
    const std::vector<std::string> entries = sorted_entries(folder);
    std::vector<std::string> frames;
    std::copy_if(entries.begin(), entries.end(), std::back_inserter(frames), data::is_image);
    if (!frames.empty()) return {images(folder, std::move(frames))};
    std::vector<Recording> found;
    std::error_code error;
    for (const std::string& path : entries) {
        if (data::is_video(path)) found.push_back(video(path, rate));
        if (!below || !fs::is_directory(path, error)) continue;
        for (Recording& recording : in_folder(path, rate, false))
            found.push_back(std::move(recording));
    }
    return found;
}

diag::Result<std::vector<Recording>> recordings_at(const std::string& path, double rate) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
        auto found = in_folder(path, rate, true);
        if (!found.empty()) return found;
        return Failure{Code::unreadable_video, fmt::format("holds no recording, {}", kExpected)};
    }
    if (!data::why_unreadable(path)) return std::vector<Recording>{video(path, rate)};
    std::vector<Recording> all;
    const auto matches = data::paths_matching(path);
    for (const std::string& match : matches.value_or(std::vector<std::string>{})) {
        auto found = recordings_at(match, rate);
        if (!found) continue;
        for (Recording& recording : *found) all.push_back(std::move(recording));
    }
    if (!all.empty()) return all;
    return Failure{Code::unreadable_video, fmt::format("no such recording, {}", kExpected)};
}

}  // namespace

std::vector<Recording> find_recordings(const std::vector<std::string>& arguments, double rate,
                                       diag::Sink& sink) {
    std::vector<Recording> recordings;
    for (const std::string& argument : arguments) {
        auto found = recordings_at(argument, rate);
        if (!found) {
            sink.report(data::in_file(found.failure(), argument));
            continue;
        }
        for (Recording& recording : *found) recordings.push_back(std::move(recording));
    }
    return recordings;
}

}  // namespace etlc::embed
