// The metadata of a data set: JSON as Python writes it, templates of paths, and the list of tasks.
// Keeps true: a path does not lead out of the folder; failures name the file that is damaged.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// Parses JSON in which NaN, Infinity and -Infinity stand for null. The result is discarded where
/// the text is not JSON.
nlohmann::json parse_json(std::string_view text);

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

/// The values of the fields of a template.
struct PathNames {
    std::map<std::string, std::uint64_t> numbers;
    std::map<std::string, std::string> words;
};

/// Fills in a template of Python,
/// "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet". Failures: E0850.
diag::Result<std::string> path_from(const std::string& pattern, const PathNames& names);

struct TaskList {
    std::string file;  ///< in the folder
    std::vector<std::string> tasks;
};

/// Reads meta/tasks.jsonl (`major` 2) or meta/tasks.parquet (3). Failures: E0850, E0851.
diag::Result<TaskList> read_tasks(const std::string& folder, int major);

}  // namespace etlc::data
