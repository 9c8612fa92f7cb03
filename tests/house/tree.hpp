// The source tree, for tests about the sources themselves.
// Takes: the folder of this clone. Gives: its files and their lines. Keeps true: nothing that a
// build or a version control system made is among them, and paths are relative to the top.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace etlc::house {

/// Every file below the top folder `below` ("" for all), sorted.
std::vector<std::filesystem::path> files(const std::string& below = "");

/// Those of C++: .cpp and .hpp.
std::vector<std::filesystem::path> cpp_files(const std::string& below);

/// The bytes of a file of the tree.
std::string content(const std::filesystem::path& file);

/// What its #include lines name, without quotes or angle brackets.
std::vector<std::string> includes(const std::filesystem::path& file);

}  // namespace etlc::house
