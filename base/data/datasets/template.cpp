#include "data/datasets/template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

using diag::Code;
using diag::Failure;

/// "03d" of "{chunk_index:03d}": how many digits; nothing where it is something else.
std::optional<int> width_of(const std::string& form) {
    if (form.empty()) return 0;
    if (form.back() != 'd' || form.size() > 3) return std::nullopt;
    int width = 0;
    for (const char c : form.substr(0, form.size() - 1)) {
        if (c < '0' || c > '9') return std::nullopt;
        width = 10 * width + (c - '0');
    }
    return width;
}

bool stays_inside(const std::string& path) {
    const std::filesystem::path parts(path);
    return !path.empty() && parts.is_relative() && path.find('\0') == std::string::npos &&
           std::find(parts.begin(), parts.end(), "..") == parts.end();
}

}  // namespace

diag::Result<std::string> path_from(const std::string& pattern, const PathNames& names) {
    std::string path;
    for (std::size_t at = 0; at < pattern.size();) {
        const std::size_t open = pattern.find('{', at);
        path += pattern.substr(at, open - at);
        if (open == std::string::npos) break;
        const std::size_t close = pattern.find('}', open);
        const std::string field = pattern.substr(open + 1, close - open - 1);
        const std::size_t colon = field.find(':');
        const std::string name = field.substr(0, colon);
        const auto width = width_of(colon == std::string::npos ? "" : field.substr(colon + 1));
        const auto number = names.numbers.find(name);
        const auto word = names.words.find(name);
        const bool known = number != names.numbers.end() || word != names.words.end();
        if (close == std::string::npos || !known || !width)
            return Failure{Code::unreadable_dataset,
                           fmt::format("has the path {}, of which {} is not known",
                                       in_quotes(pattern), in_quotes("{" + field + "}"))};
        path += number != names.numbers.end() ? fmt::format("{:0{}}", number->second, *width)
                                              : word->second;
        at = close + 1;
    }
    if (!stays_inside(path))
        return Failure{
            Code::unreadable_dataset,
            fmt::format("has the path {}, which leads out of its folder", in_quotes(path))};
    return path;
}

}  // namespace etlc::data
