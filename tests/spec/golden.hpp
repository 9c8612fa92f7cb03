// Compares texts with files.
// Takes: the output of a command. Gives: a comparison with the file of expected output. Keeps true:
// with ETLC_UPDATE=1 in the environment the file is rewritten instead, and only then.
#pragma once

#include <filesystem>
#include <string>

namespace etlc::testing {

struct Outcome {
    std::string output;
    int status = -1;  ///< exit status; -1 if the command did not exit by itself
};

/// Runs a shell command in `folder`; `output` is its standard output, and its standard error if
/// `command` redirects that.
Outcome run(const std::string& command, const std::filesystem::path& folder);

/// Reads a file; a missing file counts as empty.
std::string read_text(const std::filesystem::path& path);

/// Expects `found` to be the content of `golden`. An empty text needs no file if `may_be_absent`.
void expect_golden(const std::string& found, const std::filesystem::path& golden,
                   bool may_be_absent = false);

}  // namespace etlc::testing
