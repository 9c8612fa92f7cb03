#include "data/datasets/metadata.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "data/files/file.hpp"
#include "data/parquet/table.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {

namespace {

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

}  // namespace

nlohmann::json parse_json(std::string_view text) {
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (!json.is_discarded()) return json;
    return nlohmann::json::parse(with_nulls(text), nullptr, false);
}

namespace {

using diag::Code;
using diag::Failure;

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

using diag::Code;
using diag::Failure;

diag::Result<std::vector<std::string>> read_lines(const std::string& path) {
    constexpr std::uint64_t kMaxBytes = 64U << 20U;
    const auto bytes = read_file(path, kMaxBytes, Code::unreadable_dataset);
    if (!bytes) return bytes.failure();
    std::vector<std::string> tasks;
    const auto add = [&](std::uint32_t line, const nlohmann::json& json) -> std::optional<Failure> {
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

}  // namespace

diag::Result<TaskList> read_tasks(const std::string& folder, int major) {
    const std::string file = major == 2 ? "meta/tasks.jsonl" : "meta/tasks.parquet";
    auto tasks = (major == 2 ? read_lines : read_table)(folder + "/" + file);
    if (tasks) return TaskList{file, std::move(*tasks)};
    Failure failure = tasks.failure();
    failure.message = fmt::format("{}: {}", file, failure.message);
    return failure;
}

}  // namespace etlc::data
