#include "report/page.hpp"

#include <algorithm>

#include "report/blob.hpp"

namespace etlc::report {

const PageFile& page_file(const std::vector<PageFile>& files, std::string_view name) {
    return *std::find_if(files.begin(), files.end(),
                         [&](const PageFile& file) { return file.name == name; });
}

std::string hash_source(const PageFile& file) {
    std::string bytes;
    for (std::size_t i = 0; i < file.sha256.size(); i += 2)
        bytes += static_cast<char>(std::stoi(std::string(file.sha256.substr(i, 2)), nullptr, 16));
    return "'sha256-" + base64(bytes) + "'";
}

std::string filled(std::string_view frame,
                   const std::map<std::string, std::string, std::less<>>& parts) {
    std::string text;
    for (std::size_t at = 0;;) {
        const std::size_t open = frame.find("{{", at);
        text += frame.substr(at, open - at);
        if (open == std::string_view::npos) return text;
        const std::size_t close = frame.find("}}", open);
        text += parts.find(frame.substr(open + 2, close - open - 2))->second;
        at = close + 2;
    }
}

Frame frame_of(const std::string& figures) {
    constexpr std::string_view kData = "{{data}}";
    const auto& files = page_files();
    const PageFile& d3 = page_file(files, "d3.js");
    const PageFile& script = page_file(files, "page.js");
    const PageFile& style = page_file(files, "page.css");
    const std::map<std::string, std::string, std::less<>> parts{
        {"style", std::string(style.text)},
        {"style-hash", hash_source(style)},
        {"d3", std::string(d3.text)},
        {"d3-licence", std::string(page_file(files, "d3_licence.txt").text)},
        {"script", std::string(script.text)},
        {"script-hashes", hash_source(d3) + " " + hash_source(script)},
        {"figures", figures}};
    const std::string_view page = page_file(files, "page.html").text;
    const std::size_t at = page.find(kData);
    return {filled(page.substr(0, at), parts), filled(page.substr(at + kData.size()), parts)};
}

std::string what_is_missing() {
    const auto& files = page_files();
    const bool draws = std::any_of(files.begin(), files.end(),
                                   [](const PageFile& file) { return file.name == "d3.js"; });
    return draws ? ""
                 : "this etlc was built without the library that draws its pages: install "
                   "libjs-d3 and build it again";
}

}  // namespace etlc::report
