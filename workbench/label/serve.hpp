// Serves the page of `etlc label` until it is stopped: answers what etlc-serve passes on.
// Keeps true: a label is on disk before the page hears of it; one page at a time may label.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "diag/diag.hpp"
#include "label/desk.hpp"
#include "label/frames.hpp"
#include "label/service.hpp"
#include "report/document.hpp"

namespace etlc::label {

struct ServeRequest {
    std::string page;
    std::uint32_t port = 0;  ///< 0: any free one
    /// Called once with the address of the page; false ends the service.
    std::function<bool(const std::string& address)> ready;
};

/// Serves until the process is stopped. Returns why it ended otherwise.
diag::Failure serve(Desk& desk, Frames& frames, Background& background,
                    const ServeRequest& request);

// The page of `etlc label`: its own files beside the modules of `etlc report`, the chart library
// and the list of episodes, in one HTML text.

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
