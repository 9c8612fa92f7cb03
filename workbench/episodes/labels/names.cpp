// Finds the episodes that a table of labels names.
#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "episodes/labels/labels.hpp"
#include "recordings/datasets/dataset.hpp"
#include "recordings/hdf5/hdf5.hpp"

namespace etlc::episodes {

namespace {

namespace fs = std::filesystem;

/// The parts of the path of an episode.
struct EpisodePath {
    std::string file;   ///< the file, or the folder of the data set
    std::string group;  ///< of the file, or the number in the data set; empty: none
    bool is_number = false;
};

EpisodePath parts_of(const std::string& episode) {
    EpisodePath parts;
    const std::string file = data::trace_file(episode);
    parts.is_number = data::dataset_path(episode).has_value();
    parts.file = fs::path(file).lexically_normal().string();
    if (parts.is_number && parts.file.ends_with('/')) parts.file.pop_back();
    if (file.size() < episode.size()) parts.group = episode.substr(file.size() + 1);
    return parts;
}

/// Returns "3" for "000003".
std::string_view without_zeros(std::string_view number) {
    const std::size_t first = number.find_first_not_of('0');
    return first == std::string_view::npos ? "0" : number.substr(first);
}

/// Returns the whole names of an episode, the path first.
std::vector<std::string> whole_names(const EpisodePath& parts) {
    if (parts.group.empty()) {
        std::vector<std::string> names{parts.file};
        const fs::path path(parts.file);
        if (recordings::is_trace(parts.file))
            names.push_back((path.parent_path() / path.stem()).string());
        return names;
    }
    std::vector<std::string> names{parts.file + ":" + parts.group};
    if (parts.is_number)
        names.push_back(parts.file + ":" + std::string(without_zeros(parts.group)));
    return names;
}

std::vector<std::string> traces_in(const std::string& folder) {
    std::vector<std::string> found;
    std::error_code error;
    for (fs::directory_iterator it(folder.empty() ? "." : folder, error), end; !error && it != end;
         it.increment(error))
        if (recordings::is_trace(it->path().string())) found.push_back(it->path().string());
    return found;
}

/// Calls `take(name)` with each end of a whole name that names the episode too.
template <class Take>
void for_each_end(const EpisodePath& parts, const std::string& name, const Take& take) {
    for (std::size_t at = name.find_first_of("/:"); at != std::string::npos;
         at = name.find_first_of("/:", at + 1))
        if (name[at] == '/' || at == parts.file.size()) take(name.substr(at + 1));
}

void add(std::size_t episode, const std::string& name, bool is_whole, std::set<std::string>& whole,
         Named& names) {
    const auto found = names.find(name);
    if (found == names.end()) return;
    std::vector<std::size_t>& of = found->second;
    if (is_whole) {
        if (whole.insert(name).second) of.clear();
        of.push_back(episode);
        return;
    }
    if (whole.contains(name) || of.size() > 1 || (!of.empty() && of.back() == episode)) return;
    of.push_back(episode);
}

}  // namespace

std::string folder_of(const std::string& episode) {
    const std::string file = data::trace_file(episode);
    if (data::dataset_path(episode)) return file;
    return fs::path(file).parent_path().string();
}

std::vector<std::string> folders_of(const std::string& episode) {
    const EpisodePath parts = parts_of(episode);
    std::error_code ignored;
    const fs::path file = fs::absolute(parts.file, ignored).lexically_normal();
    std::vector<std::string> folders;
    const auto add_all = [&](const fs::path& path) {
        for (const fs::path& part : path)
            if (!part.empty()) folders.push_back(part.string());
    };
    add_all(parts.is_number ? file : file.parent_path());
    const fs::path groups = fs::path(parts.is_number ? "" : parts.group).parent_path();
    if (!groups.empty()) folders.push_back(file.filename().string());
    add_all(groups);
    return folders;
}

void find_named(const std::vector<std::string>& episodes, Named& names) {
    std::set<std::string> whole;
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        const EpisodePath parts = parts_of(episodes[e]);
        bool is_path = true;
        for (const std::string& name : whole_names(parts)) {
            add(e, name, is_path, whole, names);
            is_path = false;
            for_each_end(parts, name,
                         [&](const std::string& end) { add(e, end, false, whole, names); });
        }
    }
}

std::vector<std::string> shortest_names(const std::vector<std::string>& episodes) {
    const auto normal = [](const std::string& path) {
        return fs::path(path).lexically_normal().string();
    };
    const std::size_t count = episodes.size();
    std::vector<std::string> all = episodes;
    std::set<std::string> known;
    for (const std::string& path : episodes) known.insert(normal(path));
    for (const std::string& path : neighbours_of(episodes))
        if (known.insert(normal(path)).second) all.push_back(path);
    Named named;
    std::vector<std::vector<std::string>> names(count);
    for (std::size_t e = 0; e < count; ++e) {
        const EpisodePath parts = parts_of(all[e]);
        for (const std::string& name : whole_names(parts)) {
            names[e].push_back(name);
            for_each_end(parts, name, [&](const std::string& end) { names[e].push_back(end); });
        }
        std::stable_sort(names[e].begin(), names[e].end(),
                         [](const auto& a, const auto& b) { return a.size() < b.size(); });
        for (const std::string& name : names[e]) named[name];
    }
    find_named(all, named);
    std::vector<std::string> shortest;
    for (std::size_t e = 0; e < count; ++e) {
        const auto found = std::find_if(names[e].begin(), names[e].end(), [&](const auto& name) {
            return named.at(name) == std::vector<std::size_t>{e};
        });
        shortest.push_back(found == names[e].end() ? all[e] : *found);
    }
    return shortest;
}

std::vector<std::string> neighbours_of(const std::vector<std::string>& episodes) {
    std::set<std::string> places;
    std::vector<std::string> found;
    for (const std::string& episode : episodes) {
        const EpisodePath parts = parts_of(episode);
        if (parts.is_number) {
            const auto set = recordings::Dataset::known(parts.file);
            if (!set || !places.insert(parts.file).second) continue;
            for (const recordings::DatasetEpisode& one : (*set)->episodes())
                found.push_back(recordings::episode_path(parts.file, one.index));
            continue;
        }
        const std::string folder = folder_of(episode);
        const std::string pattern =
            parts.group.empty() ? "" : (fs::path(parts.group).parent_path() / "*").string();
        if (!places.insert(folder + ":" + pattern).second) continue;
        for (const std::string& file : traces_in(folder)) {
            if (pattern.empty()) found.push_back(file);
            if (pattern.empty() || !data::is_hdf5(file)) continue;
            const auto groups = recordings::list_hdf5(file, pattern);
            if (!groups) continue;
            for (const std::string& group : *groups) found.push_back(file + ":" + group);
        }
    }
    return found;
}

bool is_episode_in(const std::string& folder, const std::string& name) {
    const std::string path = (fs::path(folder) / name).string();
    std::error_code ignored;
    const auto exists = [&](const std::string& file) { return fs::is_regular_file(file, ignored); };
    if (exists(data::trace_file(path))) return true;
    for (const char* ending : {".csv", ".npz", ".h5", ".hdf5"})
        if (exists(path + ending)) return true;
    return false;
}

}  // namespace etlc::episodes
