// The page of `etlc label`: its own files beside the modules of `etlc report`, the chart library
// and the list of episodes, in one HTML text.
#pragma once

#include <string>
#include <vector>

#include "label/desk.hpp"
#include "report/page.hpp"

namespace etlc::label {

/// The files of the page, embedded when etlc was built.
const std::vector<report::PageFile>& page_files();

struct PageRequest {
    std::string spec;  ///< its name
    std::string spec_path;
    double step_seconds = 0;
    std::vector<bool> has_frames;  ///< per episode
};

std::string page_of(const Desk& desk, const PageRequest& request);

}  // namespace etlc::label
