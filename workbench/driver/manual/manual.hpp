// `etlc --completion bash`, `etlc --man`, docs/command_line.md and a module of the Python package,
// made from the table of options.
// Keeps true: every command and every option is in each of them.
#pragma once

#include <string>

namespace etlc::driver {

/// Makes docs/command_line.md.
std::string command_line_page();

/// Makes python/etlc/_options.py.
std::string python_options();

/// Run `etlc --completion bash` and `etlc --man`, and return the exit status. zsh reads --help, and
/// fish the manual page.
int completion_command(const std::string& shell);
int manual_command();

}  // namespace etlc::driver
