// What every command does with its arguments and its findings.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "source/source.hpp"

namespace etlc::driver {

/// Prints the findings as `form` says, "text" or "json"; the exit status that they mean.
int conclude(const std::string& form, const source::File& file, const diag::Sink& sink);

/// Says what is wrong with the call; the exit status.
int complain(const CLI::App& app, const std::string& mistake);

/// The same of a first word that is neither an option nor a spec, but was meant as one of the
/// `commands`; nothing where it may be a spec.
std::optional<int> check_command(int argc, char** argv, const std::vector<std::string>& commands);

/// An exit status where the command ends here: --help, --version, a wrong call.
std::optional<int> parse_arguments(CLI::App& app, int argc, char** argv);

}  // namespace etlc::driver
