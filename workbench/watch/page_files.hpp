// The files of the page, embedded when etlc was built.
#pragma once

#include <vector>

#include "report/page.hpp"

namespace etlc::watch {

const std::vector<report::PageFile>& page_files();

}  // namespace etlc::watch
