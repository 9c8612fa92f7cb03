// `etlc --completion bash`, `etlc --man`, docs/command_line.md and a module of the Python package,
// made from the table of options.
// Keeps true: every command and every option is in each of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace etlc::driver {

/// The help for an option, a flag or a positional argument.
struct OptionHelp {
    std::vector<std::string> names;  ///< "-o", "--output"; empty: a positional
    std::string value;  ///< the kind of its value, "FILE"; empty: none, or one of `words`
    std::vector<std::string> words;  ///< its possible values
    std::string usual;               ///< default value
    std::string text;                ///< may have several lines
    bool is_flag = false;            ///< an optional value follows '='
    bool repeats = false;
    bool is_required = false;
};

struct CommandHelp {
    std::string name;  ///< "etlc", "etlc run"
    std::string text;
    std::string footer;
    std::vector<OptionHelp> options;
};

/// Returns the help of all commands, that of etlc itself first.
std::vector<CommandHelp> all_help();

/// Makes the completion script of bash. zsh reads --help, and fish the manual page.
std::string completion_of_bash(const std::vector<CommandHelp>& commands);

/// Makes the page for man and groff.
std::string manual_page(const std::vector<CommandHelp>& commands, const std::string& version);

/// Makes docs/command_line.md.
std::string command_line_page();

/// Makes python/etlc/_options.py.
std::string python_options();

/// Run `etlc --completion bash` and `etlc --man`, and return the exit status.
int completion_command(const std::string& shell);
int manual_command();

/// The kinds of paths that an option takes.
enum class Paths : std::uint8_t { none, files, specs, folders };
Paths paths_of(const OptionHelp& option);

/// Returns "run" for "etlc run".
std::string word_of(const CommandHelp& command);

/// Options of etlc that stand alone and are not in the table.
inline constexpr const char* kOwnWords[] = {"--completion", "--man"};

}  // namespace etlc::driver
