// Paths and patterns of files, as the shell has them.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace etlc::data {

/// A path that is relative to the folder of `file`, as `file` itself is written.
std::string beside(const std::string& file, const std::string& path);

/// A path as a pattern that matches it alone.
std::string literal(const std::string& path);

/// Sorted bytewise, whatever the locale; nothing where a folder of the pattern cannot be read.
std::optional<std::vector<std::string>> paths_matching(const std::string& pattern);

}  // namespace etlc::data
