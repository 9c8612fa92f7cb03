#include "tree.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

namespace etlc::house {

namespace fs = std::filesystem;

namespace {

const fs::path kTop = ETLC_SOURCE_DIR;

/// Folders that .gitignore keeps out of the repository, and git's own.
bool foreign(const fs::path& folder) {
    const std::string name = folder.filename();
    return name == ".git" || name == "build" || name == "out" || name.starts_with("build-") ||
           name == "__pycache__";
}

}  // namespace

std::vector<fs::path> files(const std::string& below) {
    std::vector<fs::path> found;
    for (auto entry = fs::recursive_directory_iterator(kTop / below);
         entry != fs::recursive_directory_iterator(); ++entry) {
        if (entry->is_directory() && foreign(entry->path())) {
            entry.disable_recursion_pending();
        } else if (entry->is_regular_file() && entry->path().extension() != ".swp") {
            found.push_back(entry->path().lexically_relative(kTop));
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<fs::path> cpp_files(const std::string& below) {
    std::vector<fs::path> found = files(below);
    std::erase_if(found, [](const fs::path& file) {
        return file.extension() != ".cpp" && file.extension() != ".hpp";
    });
    return found;
}

std::string content(const fs::path& file) {
    std::ostringstream bytes;
    bytes << std::ifstream(kTop / file, std::ios::binary).rdbuf();
    return bytes.str();
}

std::vector<std::string> includes(const fs::path& file) {
    // A name with a blank is a message to stop compilers (build.hpp), not a file.
    static const std::regex kInclude(R"(^\s*#\s*include\s*["<]([^"> ]+)[">])");
    std::vector<std::string> found;
    std::istringstream lines(content(file));
    for (std::string line; std::getline(lines, line);) {
        if (std::smatch match; std::regex_search(line, match, kInclude)) found.push_back(match[1]);
    }
    return found;
}

}  // namespace etlc::house
