#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "data/datasets/dataset.hpp"
#include "data/text/quote.hpp"

namespace etlc::data {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> datasets_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (is_dataset(it->path().string())) names.push_back(it->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

/// Returns the owner and name of a data set of the Hub, "lerobot/pusht", for
/// "hf://datasets/lerobot/pusht" or "https://huggingface.co/datasets/lerobot/pusht"; else "".
std::string name_on_hub(const std::string& path) {
    static const std::regex kName(
        "(?:(?:hf://|https?://huggingface\\.co/)(?:datasets/)?)?"
        "([A-Za-z0-9][\\w.-]{0,95}/[A-Za-z0-9][\\w.-]{0,95})/?");
    constexpr std::size_t kLongest = 300;
    std::smatch found;
    if (path.size() > kLongest || !std::regex_match(path, found, kName)) return "";
    std::error_code error;
    const bool is_here = fs::exists(fs::path(path).parent_path(), error);
    return is_here ? "" : found[1].str();
}

}  // namespace

std::string with_dataset_meant(const std::string& why, const std::string& path) {
    for (std::size_t at = path.find(':'); at != std::string::npos; at = path.find(':', at + 1)) {
        const std::string folder = path.substr(0, at);
        if (is_dataset(folder))
            return fmt::format(
                "{} chooses no episodes of the data set: {} is episode 3, {} are the episodes 0 to "
                "49",
                in_quotes(path.substr(at)), in_quotes(folder + ":3"), in_quotes(folder + ":0:50"));
    }
    std::error_code error;
    if (fs::is_directory(path, error)) {
        const std::vector<std::string> inside = datasets_in(path);
        return inside.empty() ? why
                              : fmt::format("{}; it holds data sets: {}", why, listed(inside));
    }
    // Drop the choice of episodes, which is not the colon of "https://".
    const std::size_t scheme = path.find("://");
    const std::string name =
        path.substr(0, path.find(':', scheme == std::string::npos ? 0 : scheme + 1));
    if (fs::is_directory(name, error))
        return fmt::format("{}; {} has no meta/info.json and is no data set", why, in_quotes(name));
    if (const std::string hub = name_on_hub(name); !hub.empty())
        return fmt::format(
            "{}; etlc downloads nothing: a data set of the Hugging Face Hub comes by "
            "`hf download --repo-type dataset {} --local-dir FOLDER`, and FOLDER "
            "is then what etlc reads",
            why, hub);
    const fs::path parent = fs::path(name).parent_path();
    const auto meant = diag::nearest_name(fs::path(name).filename().string(),
                                          datasets_in(parent.empty() ? "." : parent));
    if (!meant) return why;
    return fmt::format("{}; did you mean the data set {}?", why,
                       in_quotes((parent / *meant).string()));
}

}  // namespace etlc::data
