// What a command says of itself: the apps of CLI11, from which --help is printed too.
// Takes: the function of a command. Gives: its options, for completion and for the manual page.
// Keeps true: there is no other list of options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace etlc::driver {

/// Of an option, a flag or a positional.
struct OptionHelp {
    std::vector<std::string> names;  ///< "-o", "--output"; empty: a positional
    std::string value;               ///< what it takes: "FILE"; empty: nothing, or one of `words`
    std::vector<std::string> words;  ///< that it takes
    std::string usual;               ///< where it is absent
    std::string text;                ///< may have several lines
    bool is_flag = false;            ///< its value, if any, is behind a '='
    bool repeats = false;
    bool is_required = false;
};

struct CommandHelp {
    std::string name;  ///< "etlc", "etlc run"
    std::string text;
    std::string footer;
    std::vector<OptionHelp> options;
};

/// A command's function, as main() calls it.
using CommandFunction = int (*)(int argc, char** argv);

/// Its app. The function is called, and comes as far as parse_arguments().
CommandHelp help_of(CommandFunction command);

/// For parse_arguments(): throws what the app says where help_of() has called.
void tell_help(const CLI::App& app, int argc, char** argv);

}  // namespace etlc::driver
