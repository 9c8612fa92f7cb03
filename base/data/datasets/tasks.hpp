// The tasks of a data set, in words.
// Takes: its folder. Gives: the words of meta/tasks.jsonl or meta/tasks.parquet. Keeps true: a file
// that is damaged is a failure (E0850, E0851) that names it.
#pragma once

#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

struct TaskList {
    std::string file;  ///< in the folder
    std::vector<std::string> tasks;
};

/// `major`: 2 or 3, of the data set's version.
diag::Result<TaskList> read_tasks(const std::string& folder, int major);

}  // namespace etlc::data
