// `etlc report`, and `etlc run --html`: a page to look at.
// Takes: a compiled spec and recorded episodes. Gives: one HTML file. Keeps true: the file appears
// whole or not at all; where truths are known, the figures are those of `etlc evaluate`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "driver/compile/compile.hpp"
#include "report/report.hpp"

namespace etlc::driver {

struct ReportRequest {
    std::vector<std::string> data;  ///< files, folders and patterns
    std::string groups;             ///< of .h5 files that are episodes
    std::string allow_overlap;
    report::Request report;       ///< its episodes, progress and limits are set here
    bool without_truths = false;  ///< also where they are known
    std::string output;
};

/// False where the sink now says why not.
bool report(const source::File& spec, const Compiled& compiled, const Request& request,
            const ReportRequest& asked, diag::Sink& sink);

/// The page of one trace, without truths. Nothing where the sink now says why.
std::optional<std::string> page_of_trace(const source::File& spec, const Compiled& compiled,
                                         const std::string& trace, const data::NamesInFile& names,
                                         diag::Sink& sink);

}  // namespace etlc::driver
