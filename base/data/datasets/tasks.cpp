#include "data/datasets/tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>

#include "data/datasets/json_lines.hpp"
#include "data/files/file.hpp"
#include "data/parquet/table.hpp"

namespace etlc::data {
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

/// The words are the index of a table of pandas, whose name depends on its version.
diag::Result<std::vector<std::string>> read_table(const std::string& path) {
    auto table = Table::open(path, {"task", "__index_level_0__"});
    if (!table) return table.failure();
    const auto& columns = (*table)->columns();
    const std::size_t place = columns[0].is_there ? 0 : 1;
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
