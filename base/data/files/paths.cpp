#include "data/files/paths.hpp"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <string_view>

namespace etlc::data {

std::string beside(const std::string& file, const std::string& path) {
    return (std::filesystem::path(file).parent_path() / path).lexically_normal().string();
}

std::string literal(const std::string& path) {
    std::string result;
    for (const char c : path) {
        if (std::string_view("*?[]\\").find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
    return result;
}

std::optional<std::vector<std::string>> paths_matching(const std::string& pattern) {
    glob_t found{};
    const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
    std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
    ::globfree(&found);
    if (status != 0 && status != GLOB_NOMATCH) return std::nullopt;
    std::sort(paths.begin(), paths.end());
    return paths;
}

}  // namespace etlc::data
