#include "recordings/datasets/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "recordings/parquet/table.hpp"

namespace etlc::recordings {

using namespace data;
namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;
using Json = nlohmann::json;

constexpr const char* kInfo = "meta/info.json";
constexpr std::uint64_t kMaxInfoBytes = 64U << 20U;
constexpr std::uint64_t kMaxEpisodesBytes = 512U << 20U;
constexpr double kMaxWhole = 9007199254740992;  // 2^53

Failure wrong(const std::string& file, const std::string& why) {
    return {Code::unreadable_dataset, fmt::format("{} {}", file, why)};
}

std::optional<std::uint64_t> whole(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number()) return std::nullopt;
    const double value = found->get<double>();
    if (!(value >= 0) || value > kMaxWhole || value != std::floor(value)) return std::nullopt;
    return static_cast<std::uint64_t>(value);
}

std::string shown(const Json& json) {
    return in_quotes(json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::optional<std::string> text(const Json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_string()) return std::nullopt;
    return found->get<std::string>();
}

/// Replaces the numbers that JSON does not have by null, outside of strings.
std::string with_nulls(std::string_view text) {
    constexpr std::array<std::string_view, 3> kNumbers = {"NaN", "Infinity", "-Infinity"};
    std::string result;
    bool in_string = false;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t taken = in_string && text[at] == '\\' ? 2 : 1;
        if (text[at] == '"') in_string = !in_string;
        std::string_view piece = text.substr(at, taken);
        for (const std::string_view number : kNumbers)
            if (!in_string && text.substr(at).starts_with(number)) {
                piece = "null";
                taken = number.size();
                break;
            }
        result += piece;
        at += taken;
    }
    return result;
}

/// Parses JSON in which NaN, Infinity and -Infinity stand for null. The result is discarded where
/// the text is not JSON.
Json parse_json(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_discarded()) return json;
    return Json::parse(with_nulls(text), nullptr, false);
}

/// Calls `visit(line, json)` for each line that is not blank, counted from 1; `json` is discarded
/// where the line is not JSON. Stops at the first failure that `visit` returns.
template <class Visit>
std::optional<diag::Failure> for_each_json_line(std::string_view text, const Visit& visit) {
    std::uint32_t line = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view words = text.substr(at, end - at);
        at = end + 1;
        ++line;
        if (words.find_first_not_of(" \t\r") == std::string_view::npos) continue;
        std::optional<diag::Failure> failure = visit(line, parse_json(words));
        if (failure) return failure;
    }
    return std::nullopt;
}

/// Returns 3 for the format "03d" of "{chunk_index:03d}"; nothing for other formats.
std::optional<int> width_of(const std::string& form) {
    if (form.empty()) return 0;
    if (form.back() != 'd' || form.size() > 3) return std::nullopt;
    int width = 0;
    for (const char c : form.substr(0, form.size() - 1)) {
        if (c < '0' || c > '9') return std::nullopt;
        width = 10 * width + (c - '0');
    }
    return width;
}

bool stays_inside(const std::string& path) {
    const std::filesystem::path parts(path);
    return !path.empty() && parts.is_relative() && path.find('\0') == std::string::npos &&
           std::find(parts.begin(), parts.end(), "..") == parts.end();
}

}  // namespace

diag::Failure in_part(const std::string& file, diag::Failure failure) {
    failure.message = fmt::format("{}: {}", file, failure.message);
    return failure;
}

diag::Result<std::string> path_from(const std::string& pattern, const PathNames& names) {
    std::string path;
    for (std::size_t at = 0; at < pattern.size();) {
        const std::size_t open = pattern.find('{', at);
        path += pattern.substr(at, open - at);
        if (open == std::string::npos) break;
        const std::size_t close = pattern.find('}', open);
        const std::string field = pattern.substr(open + 1, close - open - 1);
        const std::size_t colon = field.find(':');
        const std::string name = field.substr(0, colon);
        const auto width = width_of(colon == std::string::npos ? "" : field.substr(colon + 1));
        const auto number = names.numbers.find(name);
        const auto word = names.words.find(name);
        const bool known = number != names.numbers.end() || word != names.words.end();
        if (close == std::string::npos || !known || !width)
            return Failure{Code::unreadable_dataset,
                           fmt::format("has the path {} with the unknown field {}",
                                       in_quotes(pattern), in_quotes("{" + field + "}"))};
        path += number != names.numbers.end() ? fmt::format("{:0{}}", number->second, *width)
                                              : word->second;
        at = close + 1;
    }
    if (!stays_inside(path))
        return Failure{
            Code::unreadable_dataset,
            fmt::format("has the path {}, which leads out of its folder", in_quotes(path))};
    return path;
}

namespace {

diag::Result<std::vector<std::string>> read_lines(const std::string& path) {
    constexpr std::uint64_t kMaxBytes = 64U << 20U;
    const auto bytes = read_file(path, kMaxBytes, Code::unreadable_dataset);
    if (!bytes) return bytes.failure();
    std::vector<std::string> tasks;
    const auto add = [&](std::uint32_t line, const Json& json) -> std::optional<Failure> {
        if (!json.is_object() || !json.contains("task") || !json["task"].is_string())
            return Failure{Code::unreadable_dataset,
                           fmt::format("line {} is not an object with a task", line)};
        tasks.push_back(json["task"].get<std::string>());
        return std::nullopt;
    };
    if (auto failure = for_each_json_line(*bytes, add)) return *failure;
    return tasks;
}

/// Reads tasks from the index of a pandas table, whose name depends on the version.
diag::Result<std::vector<std::string>> read_table(const std::string& path) {
    auto table = Table::open(path, {"task", "__index_level_0__"});
    if (!table) return table.failure();
    const auto& columns = (*table)->columns();
    const std::size_t place = columns[0].exists ? 0 : 1;
    if (!columns[place].is_text || columns[place].is_list)
        return Failure{Code::unreadable_dataset, "has no column 'task' of text"};
    std::vector<std::string> tasks;
    std::vector<Table::Cell> cells;
    for (;;) {
        const auto more = (*table)->next(cells);
        if (!more) return more.failure();
        if (!*more) return tasks;
        if (!cells[place].is_null) tasks.push_back(cells[place].texts[0]);
    }
}

struct TaskList {
    std::string file;  ///< in the folder
    std::vector<std::string> tasks;
};

/// Reads meta/tasks.jsonl (`major` 2) or meta/tasks.parquet (3). Failures: E0850, E0851.
diag::Result<TaskList> read_tasks(const std::string& folder, int major) {
    const std::string file = major == 2 ? "meta/tasks.jsonl" : "meta/tasks.parquet";
    auto tasks = (major == 2 ? read_lines : read_table)(folder + "/" + file);
    if (tasks) return TaskList{file, std::move(*tasks)};
    return in_part(file, tasks.failure());
}

}  // namespace

/// Reads the metadata of a data set.
class DatasetReader {
public:
    explicit DatasetReader(const std::string& folder) : set_(std::make_shared<Dataset>()) {
        set_->folder_ = folder;
    }

    diag::Result<std::shared_ptr<Dataset>> read() {
        if (auto failure = read_info()) return *failure;
        if (auto failure = set_->major_ == 2 ? read_lines() : read_tables()) return *failure;
        auto& episodes = set_->episodes_;
        std::sort(episodes.begin(), episodes.end(),
                  [](const auto& a, const auto& b) { return a.index < b.index; });
        for (std::size_t i = 1; i < episodes.size(); ++i)
            if (episodes[i].index == episodes[i - 1].index)
                return wrong(place_, fmt::format("has episode {} twice", episodes[i].index));
        if (episodes.empty()) return wrong(place_, "has no episode");
        find_whole_videos();
        compare();
        return std::move(set_);
    }

private:
    std::optional<Failure> read_info() {
        const auto bytes = read_file(set_->path_of(kInfo), kMaxInfoBytes, Code::unreadable_dataset);
        if (!bytes) return in_part(kInfo, bytes.failure());
        info_ = parse_json(*bytes);
        if (!info_.is_object()) return wrong(kInfo, "is not JSON, or no object");
        const auto version = text(info_, "codebase_version");
        if (!version) return wrong(kInfo, "does not say its codebase_version");
        if (*version != "v2.0" && *version != "v2.1" && *version != "v3.0")
            return wrong(kInfo, fmt::format("is of the version {}, expected v2.0, v2.1 or v3.0; "
                                            "LeRobot converts others",
                                            in_quotes(*version)));
        set_->major_ = (*version)[1] - '0';
        const auto fps = info_.find("fps");
        if (fps == info_.end() || !fps->is_number() || !(fps->get<double>() > 0) ||
            !(fps->get<double>() < 1e6))
            return wrong(kInfo, "does not give its rows per second (fps)");
        set_->fps_ = fps->get<double>();
        const auto features = info_.find("features");
        if (features == info_.end() || !features->is_object())
            return wrong(kInfo, "does not list its features");
        for (const auto& [name, feature] : features->items()) {
            const auto type = feature.is_object() ? text(feature, "dtype") : std::nullopt;
            if (!type)
                return wrong(kInfo, fmt::format("does not say the dtype of {}", in_quotes(name)));
            set_->features_.push_back({name, *type});
        }
        return std::nullopt;
    }

    /// Reads meta/episodes.jsonl, an object a line.
    std::optional<Failure> read_lines() {
        place_ = "meta/episodes.jsonl";
        const auto bytes =
            read_file(set_->path_of(place_), kMaxEpisodesBytes, Code::unreadable_dataset);
        if (!bytes) return in_part(place_, bytes.failure());
        const auto add = [&](std::uint32_t line, const Json& json) -> std::optional<Failure> {
            const auto index = json.is_object() ? whole(json, "episode_index") : std::nullopt;
            const auto length = json.is_object() ? whole(json, "length") : std::nullopt;
            if (!index || !length)
                return wrong(place_, fmt::format("line {} is not an object with episode_index and "
                                                 "length, whole numbers",
                                                 line));
            DatasetEpisode episode{*index, *length, {}, {}, {}};
            const auto tasks = json.find("tasks");
            if (tasks != json.end() && tasks->is_array())
                for (const Json& task : *tasks) {
                    if (!task.is_string())
                        return wrong(place_, fmt::format("line {} has {} among its tasks, expected "
                                                         "texts",
                                                         line, shown(task)));
                    episode.tasks.push_back(task.get<std::string>());
                }
            if (auto failure = place_lines(episode)) return failure;
            set_->episodes_.push_back(std::move(episode));
            return std::nullopt;
        };
        return for_each_json_line(*bytes, add);
    }

    std::optional<Failure> place_lines(DatasetEpisode& episode) {
        const std::uint64_t chunk_size = whole(info_, "chunks_size").value_or(0);
        if (chunk_size == 0)
            return wrong(kInfo, "does not say its chunks_size, a whole number from 1");
        PathNames names{
            {{"episode_index", episode.index}, {"episode_chunk", episode.index / chunk_size}}, {}};
        const auto rows = path("data_path", names);
        if (!rows) return rows.failure();
        episode.rows = *rows;
        for (const std::string& camera : set_->videos()) {
            names.words["video_key"] = camera;
            const auto video = path("video_path", names);
            if (!video) return video.failure();
            episode.clips[camera] = {*video, 0, 0, true};
        }
        return std::nullopt;
    }

    /// Fills in a template of info.json.
    diag::Result<std::string> path(const char* key, const PathNames& names) {
        const auto pattern = text(info_, key);
        if (!pattern) return wrong(kInfo, fmt::format("does not give its {}", key));
        auto path = path_from(*pattern, names);
        if (!path) return in_part(kInfo, path.failure());
        return path;
    }

    /// Reads meta/episodes/*/*.parquet, a row an episode.
    std::optional<Failure> read_tables() {
        place_ = "meta/episodes";
        const std::string prefix = set_->folder() + "/";
        const auto files = paths_matching(literal(prefix) + "meta/episodes/*/*.parquet");
        if (!files || files->empty()) return wrong(place_, "holds no Parquet files of episodes");
        for (const std::string& file : *files) {
            const std::string part = file.substr(prefix.size());
            if (auto failure = read_table(file)) return in_part(part, *failure);
        }
        return std::nullopt;
    }

    std::optional<Failure> read_table(const std::string& file) {
        const std::vector<std::string> cameras = set_->videos();
        std::vector<std::string> names = {"episode_index", "length", "data/chunk_index",
                                          "data/file_index", "tasks"};
        for (const std::string& camera : cameras)
            for (const char* what : {"chunk_index", "file_index", "from_timestamp", "to_timestamp"})
                names.push_back(fmt::format("videos/{}/{}", camera, what));
        auto table = Table::open(file, names);
        if (!table) return table.failure();
        for (std::size_t i = 0; i < names.size(); ++i) {
            const Table::Column& column = (*table)->columns()[i];
            if (names[i] == "tasks") continue;
            if (!column.exists || column.is_text || column.is_list)
                return Failure{Code::unreadable_dataset,
                               fmt::format("has no column {} of numbers", in_quotes(names[i]))};
        }
        std::vector<Table::Cell> cells;
        for (;;) {
            const auto more = (*table)->next(cells);
            if (!more) return more.failure();
            if (!*more) return std::nullopt;
            for (std::size_t i = 0; i < names.size(); ++i)
                if (auto failure = refuse_cell(names[i], cells[i])) return failure;
            auto episode = episode_of(cells, cameras);
            if (!episode) return episode.failure();
            set_->episodes_.push_back(std::move(*episode));
        }
    }

    static std::optional<Failure> refuse_cell(const std::string& name, const Table::Cell& cell) {
        const auto refuse = [&](const std::string& what) {
            return Failure{Code::unreadable_dataset,
                           fmt::format("has a row whose {} {}", in_quotes(name), what)};
        };
        if (name == "tasks") {
            const bool has_null =
                std::find(cell.texts.begin(), cell.texts.end(), "") != cell.texts.end();
            return has_null ? std::optional(refuse("has a task without text")) : std::nullopt;
        }
        const double number = cell.is_null ? -1 : cell.numbers[0];
        if (!(number >= 0) || number > kMaxWhole) return refuse("is no number from 0 on");
        if (number != std::floor(number) && !name.ends_with("_timestamp"))
            return refuse(fmt::format("is {}, expected a whole number", number));
        return std::nullopt;
    }

    /// `cells`: the columns that read_table requests, in their order.
    diag::Result<DatasetEpisode> episode_of(const std::vector<Table::Cell>& cells,
                                            const std::vector<std::string>& cameras) {
        const auto number = [&](std::size_t i) {
            return static_cast<std::uint64_t>(cells[i].numbers[0]);
        };
        DatasetEpisode episode{number(0), number(1), cells[4].texts, {}, {}};
        PathNames at{{{"chunk_index", number(2)}, {"file_index", number(3)}}, {}};
        const auto rows = path("data_path", at);
        if (!rows) return rows.failure();
        episode.rows = *rows;
        for (std::size_t c = 0; c < cameras.size(); ++c) {
            const std::size_t first = 5 + 4 * c;
            at.numbers = {{"chunk_index", number(first)}, {"file_index", number(first + 1)}};
            at.words["video_key"] = cameras[c];
            const auto video = path("video_path", at);
            if (!video) return video.failure();
            episode.clips[cameras[c]] = {*video, cells[first + 2].numbers[0],
                                         cells[first + 3].numbers[0], false};
        }
        return episode;
    }

    /// Some writers give the time of the last frame as the end of a video with one episode. The
    /// whole video is meant, and its frames are counted when they are decoded.
    void find_whole_videos() {
        std::map<std::string, std::size_t> episodes;
        for (const DatasetEpisode& episode : set_->episodes_)
            for (const auto& [camera, clip] : episode.clips) ++episodes[clip.path];
        for (DatasetEpisode& episode : set_->episodes_)
            for (auto& [camera, clip] : episode.clips) {
                const double frames = std::round((clip.end - clip.begin) * set_->fps_);
                const bool is_short = frames + 1 == static_cast<double>(episode.length);
                if (is_short && clip.begin == 0 && episodes[clip.path] == 1) clip.is_whole = true;
            }
    }

    /// Compares what the metadata say in two places.
    void compare() {
        std::uint64_t rows = 0;
        for (const DatasetEpisode& episode : set_->episodes_) rows += episode.length;
        const auto check = [&](const char* key, std::uint64_t found, const char* noun,
                               const std::string& where) {
            const auto promised = whole(info_, key);
            if (!promised && info_.contains(key))
                set_->contradictions_.push_back(fmt::format(
                    "{} has {} for {}, expected a whole number", kInfo, shown(info_[key]), key));
            if (promised && *promised != found)
                set_->contradictions_.push_back(fmt::format("{} promises {}, {} lists {}", kInfo,
                                                            diag::counted(*promised, noun), where,
                                                            diag::counted(found, noun)));
        };
        check("total_episodes", set_->episodes_.size(), "episode", place_);
        check("total_frames", rows, "row", place_);
        compare_tasks(check);
        find_strangers();
    }

    /// Compares the list of tasks; a data set without one is still read.
    void compare_tasks(const auto& check) {
        auto& contradictions = set_->contradictions_;
        const auto list = read_tasks(set_->folder(), set_->major_);
        if (!list) return contradictions.push_back(list.failure().message);
        check("total_tasks", list->tasks.size(), "task", list->file);
        std::set<std::string> strange;
        for (const DatasetEpisode& episode : set_->episodes_)
            strange.insert(episode.tasks.begin(), episode.tasks.end());
        for (const std::string& task : list->tasks) strange.erase(task);
        if (!strange.empty())
            contradictions.push_back(
                fmt::format("{} does not list {}, of which {} says that episodes show it",
                            list->file, listed({strange.begin(), strange.end()}), place_));
    }

    /// Reports files of rows that belong to no episode.
    void find_strangers() {
        const std::string prefix = set_->folder() + "/";
        const auto files = paths_matching(literal(prefix) + "data/*/*.parquet");
        std::vector<std::string> known;
        for (const DatasetEpisode& episode : set_->episodes_) known.push_back(episode.rows);
        std::sort(known.begin(), known.end());
        std::vector<std::string> strange;
        for (const std::string& file : files.value_or(std::vector<std::string>{}))
            if (!std::binary_search(known.begin(), known.end(), file.substr(prefix.size())))
                strange.push_back(file.substr(prefix.size()));
        if (!strange.empty())
            set_->contradictions_.push_back(fmt::format("{} {}, which the metadata do not mention",
                                                        strange.size() == 1 ? "holds" : "hold",
                                                        listed(strange)));
    }

    std::shared_ptr<Dataset> set_;
    Json info_;
    std::string place_;  ///< place of the episodes
};

diag::Result<std::shared_ptr<Dataset>> Dataset::read(const std::string& folder) {
    return within_memory([&] { return DatasetReader(folder).read(); });
}

diag::Result<std::shared_ptr<Dataset>> Dataset::known(const std::string& folder) {
    static std::mutex lock;
    static std::map<std::string, std::shared_ptr<Dataset>> sets;
    const std::lock_guard guard(lock);
    const auto found = sets.find(folder);
    if (found != sets.end()) return found->second;
    auto set = read(folder);
    if (set) sets[folder] = *set;
    return set;
}

std::vector<std::string> Dataset::cameras() const {
    std::vector<std::string> names;
    for (const Feature& feature : features_)
        if (feature.type == "video" || feature.type == "image") names.push_back(feature.name);
    return names;
}

std::vector<std::string> Dataset::videos() const {
    std::vector<std::string> names;
    for (const Feature& feature : features_)
        if (feature.type == "video") names.push_back(feature.name);
    return names;
}

const DatasetEpisode* Dataset::episode(std::uint64_t index) const {
    const auto found = std::lower_bound(
        episodes_.begin(), episodes_.end(), index,
        [](const DatasetEpisode& episode, std::uint64_t i) { return episode.index < i; });
    return found != episodes_.end() && found->index == index ? &*found : nullptr;
}

std::string episode_path(const std::string& folder, std::uint64_t index) {
    return fmt::format("{}:{:06}", folder, index);
}

std::string name_of_folder(const std::string& folder) {
    std::error_code error;
    const std::string name = fs::path(folder).lexically_normal().filename().string();
    if (!name.empty() && name != "." && name != "..") return name;
    return fs::canonical(folder, error).filename().string();
}

namespace {

std::vector<std::string> datasets_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (is_dataset(it->path().string())) names.push_back(it->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// Returns the owner and name of a data set of the Hub, "lerobot/pusht", for
/// "hf://datasets/lerobot/pusht" or "https://huggingface.co/datasets/lerobot/pusht"; else "".
std::string name_on_hub(const std::string& path) {
    static const std::regex kName(
        "(?:(?:hf://|https?://huggingface\\.co/)(?:datasets/)?)?"
        "([A-Za-z0-9][\\w.-]{0,95}/[A-Za-z0-9][\\w.-]{0,95})/?");
    constexpr std::size_t kLongest = 300;
    std::smatch found;
    if (path.size() > kLongest || !std::regex_match(path, found, kName)) return "";
    std::error_code error;
    const bool is_here = fs::exists(fs::path(path).parent_path(), error);
    return is_here ? "" : found[1].str();
}

}  // namespace

std::string with_dataset_meant(const std::string& why, const std::string& path) {
    for (std::size_t at = path.find(':'); at != std::string::npos; at = path.find(':', at + 1)) {
        const std::string folder = path.substr(0, at);
        if (is_dataset(folder))
            return fmt::format(
                "{} chooses no episodes of the data set: {} is episode 3, {} are the episodes 0 to "
                "49",
                in_quotes(path.substr(at)), in_quotes(folder + ":3"), in_quotes(folder + ":0:50"));
    }
    std::error_code error;
    if (fs::is_directory(path, error)) {
        const std::vector<std::string> inside = datasets_in(path);
        return inside.empty() ? why
                              : fmt::format("{}; it holds data sets: {}", why, listed(inside));
    }
    // Drop the choice of episodes, which is not the colon of "https://".
    const std::size_t scheme = path.find("://");
    const std::string name =
        path.substr(0, path.find(':', scheme == std::string::npos ? 0 : scheme + 1));
    if (fs::is_directory(name, error))
        return fmt::format("{}; {} has no meta/info.json and is no data set", why, in_quotes(name));
    if (const std::string hub = name_on_hub(name); !hub.empty())
        return fmt::format(
            "{}; etlc downloads nothing: a data set of the Hugging Face Hub comes by "
            "`hf download --repo-type dataset {} --local-dir FOLDER`, and FOLDER "
            "is then what etlc reads",
            why, hub);
    const fs::path parent = fs::path(name).parent_path();
    const auto meant = diag::nearest_name(fs::path(name).filename().string(),
                                          datasets_in(parent.empty() ? "." : parent));
    if (!meant) return why;
    return fmt::format("{}; did you mean the data set {}?", why,
                       in_quotes((parent / *meant).string()));
}

}  // namespace etlc::recordings
