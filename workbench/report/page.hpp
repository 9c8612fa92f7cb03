// The page: its own files, the chart library, and the data, in one text.
// Takes: JSON texts that cannot end a script element. Gives: HTML. Keeps true: a browser runs the
// two programs that etlc was built with and nothing else, and asks no network for anything: the
// page's Content-Security-Policy names their hashes, and no address.
#pragma once

#include <string>

namespace etlc::report {

/// `figures`: what `etlc evaluate --json` writes, or null.
std::string page_of(const std::string& data, const std::string& figures);

/// Empty, or why this etlc cannot make pages.
std::string what_is_missing();

}  // namespace etlc::report
