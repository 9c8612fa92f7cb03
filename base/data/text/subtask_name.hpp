// The names of inputs that say whether a step of a recording shows a subtask:
// subtask == "pick up the cup".
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace etlc::data {

/// Where LeRobot keeps the subtask of a step; the first word stands for the only place.
inline constexpr std::string_view kSubtaskWords[] = {
    "subtask", "language_persistent", "subtask_index", "sparse_subtask", "dense_subtask"};

struct SubtaskName {
    std::string_view word;
    std::string_view text;
};

/// Returns the parts of such a name; nothing for other names.
inline std::optional<SubtaskName> subtask_name(std::string_view name) {
    constexpr std::string_view kIs = " == \"";
    for (const std::string_view word : kSubtaskWords) {
        const std::size_t begin = word.size() + kIs.size();
        if (name.size() > begin && name.starts_with(word) &&
            name.substr(word.size()).starts_with(kIs))
            return SubtaskName{word, name.substr(begin, name.size() - 1 - begin)};
    }
    return std::nullopt;
}

}  // namespace etlc::data
