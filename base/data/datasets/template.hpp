// The paths of a data set's files, which its metadata give as a template of Python.
// Takes: "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet" and what stands for
// the names. Gives: the path. Keeps true: it does not lead out of the folder.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "diag/diag.hpp"

namespace etlc::data {

struct PathNames {
    std::map<std::string, std::uint64_t> numbers;
    std::map<std::string, std::string> words;
};

/// Failures: E0850.
diag::Result<std::string> path_from(const std::string& pattern, const PathNames& names);

}  // namespace etlc::data
