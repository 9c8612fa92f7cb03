#include "data/frames/images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "data/files/file.hpp"
#include "data/files/paths.hpp"

namespace etlc::data {
namespace {

namespace fs = std::filesystem;
using diag::Code;
using diag::Failure;

const std::vector<std::string> kEndings = {".png", ".jpg", ".jpeg"};

}  // namespace

bool is_image(const std::string& path) {
    std::string small = path;
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::any_of(kEndings.begin(), kEndings.end(),
                       [&](const std::string& ending) { return small.ends_with(ending); });
}

std::string image_endings() {
    return diag::alternatives(kEndings);
}

diag::Result<std::vector<std::string>> find_images(const std::string& folder,
                                                   const std::string& path) {
    const std::string prefix = folder.empty() || fs::path(path).is_absolute() ? "" : folder + "/";
    const std::string whole = prefix + path;
    std::error_code error;
    std::vector<std::string> images;
    if (fs::is_directory(whole, error)) {
        const std::string separator = path.empty() || path.ends_with('/') ? "" : "/";
        for (const auto& entry : fs::directory_iterator(whole, error))
            if (is_image(entry.path().string()))
                images.push_back(path + separator + entry.path().filename().string());
    } else if (!why_unreadable(whole)) {
        if (!is_image(path))
            return Failure{Code::unreadable_image,
                           fmt::format("unknown kind of image, expected {}", image_endings())};
        images.push_back(path);
    } else {
        const auto matches = paths_matching(literal(prefix) + path);
        for (const std::string& match : matches.value_or(std::vector<std::string>{}))
            if (is_image(match)) images.push_back(match.substr(prefix.size()));
    }
    std::sort(images.begin(), images.end());
    if (images.empty())
        return Failure{Code::unreadable_image,
                       fmt::format("no such image, folder of images or pattern of some, expected "
                                   "files that end in {}",
                                   image_endings())};
    return images;
}

}  // namespace etlc::data
