// The source tree, for tests of the sources themselves.
// Takes: the folder of this clone. Gives: its files and their lines. Keeps true: files made by a
// build or a version control system are excluded, and paths are relative to the top.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etlc::house {

/// Returns every file below the top folder `below` ("" for all), sorted.
std::vector<std::filesystem::path> files(const std::string& below = "");

/// Returns the C++ files: .cpp and .hpp.
std::vector<std::filesystem::path> cpp_files(const std::string& below);

/// Returns the bytes of a file of the tree.
std::string content(const std::filesystem::path& file);

/// Returns the names in its #include lines, without quotes or angle brackets.
std::vector<std::string> includes(const std::filesystem::path& file);

}  // namespace etlc::house
