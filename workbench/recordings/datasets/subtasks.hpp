// The subtask that an episode of a data set shows in each row, from wherever LeRobot keeps it.
// Takes: the path of an episode. Gives: the name of the subtask of each row. Keeps true: rows and
// metadata that contradict each other, and subtasks in two places, cause a failure that says where.
// Source: huggingface/lerobot, datasets/language.py and data_processing/sarm_annotations.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/text/subtask_name.hpp"
#include "diag/diag.hpp"

namespace etlc::recordings {

struct Subtasks {
    static constexpr std::int32_t kNone = -1;     ///< the row shows no subtask
    static constexpr std::int32_t kUnknown = -2;  ///< the row has no label

    std::string source;                ///< of data::kSubtaskWords; empty: it has none
    std::vector<std::string> names;    ///< of the rows; of a subtask_index, all that the set has
    std::vector<std::int32_t> of_row;  ///< its place in `names`, or one of the constants

    /// Returns whether a row shows a subtask; nothing where the row has no label.
    std::optional<bool> shows(std::size_t row, std::string_view name) const {
        const std::int32_t place = of_row[row];
        if (place == kUnknown) return std::nullopt;
        return place >= 0 && names[static_cast<std::size_t>(place)] == name;
    }
};

/// Reads the subtasks of an episode; the word is one of data::kSubtaskWords. Failures: E0850,
/// E0851, E0854, and E0862 where it has several sources.
diag::Result<Subtasks> read_subtasks(const std::string& path, std::string_view word = "subtask");

}  // namespace etlc::recordings
