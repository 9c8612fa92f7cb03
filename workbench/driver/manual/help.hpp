// What a command says of itself, for completion and for the manual page.
// Takes: the table of options. Gives: those of a command. Keeps true: there is no other list.
#pragma once

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

/// All commands, etlc itself first.
std::vector<CommandHelp> all_help();

}  // namespace etlc::driver
