// The page's own files and the chart library, as they were when etlc was built.
#pragma once

#include <string_view>
#include <vector>

namespace etlc::report {

struct PageFile {
    std::string_view name;    ///< "page.html"
    std::string_view sha256;  ///< in hexadecimal digits
    std::string_view text;
};
const std::vector<PageFile>& page_files();

/// The file of that name, which is there.
const PageFile& page_file(std::string_view name);

}  // namespace etlc::report
