// Texts that tests compare with files.
// Takes: what a command printed. Gives: a comparison with the file that holds what it should print.
// Keeps true: with ETLC_UPDATE=1 in the environment the file is rewritten instead, and only then.
#pragma once

#include <filesystem>
#include <string>

namespace etlc::testing {

struct Outcome {
    std::string output;
    int status = -1;  ///< exit status; -1 where the command did not exit by itself
};

/// Runs a shell command in `folder`; `output` is what it wrote to standard output, and to standard
/// error where `command` redirects that.
Outcome run(const std::string& command, const std::filesystem::path& folder);

/// An absent file counts as empty.
std::string read_text(const std::filesystem::path& path);

/// Expects `found` to be the content of `golden`. An empty text needs no file where
/// `may_be_absent`.
void expect_golden(const std::string& found, const std::filesystem::path& golden,
                   bool may_be_absent = false);

}  // namespace etlc::testing
