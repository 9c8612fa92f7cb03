// The page of `etlc label`: its own files beside the modules of `etlc report`, the chart library
// and the list of episodes, in one HTML text.
#pragma once

#include <string>
#include <string_view>
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

/// Returns a page with its own files, those of the report that it shares, and data as JSON.
/// `html` is the name of its frame among `own`.
std::string page_with(const std::vector<report::PageFile>& own, std::string_view html,
                      const std::string& data);

std::string page_of(const Desk& desk, const PageRequest& request);

}  // namespace etlc::label
