// `etlc --completion SHELL` and `etlc --man`.
// Takes: what the commands say of themselves, that of etlc itself first. Gives: text. Keeps true:
// every command and every option of them is in it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "driver/manual/help.hpp"

namespace etlc::driver {

/// Scripts that the shells read.
std::string completion_of_bash(const std::vector<CommandHelp>& commands);
std::string completion_of_zsh(const std::vector<CommandHelp>& commands);
std::string completion_of_fish(const std::vector<CommandHelp>& commands);

/// The page, for man and groff. `version`: of etlc.
std::string manual_page(const std::vector<CommandHelp>& commands, const std::string& version);

/// docs/command_line.md
std::string command_line_page();

/// The exit status of `etlc --completion SHELL`, and of `etlc --man`.
int completion_command(const std::string& shell);
int manual_command();

/// What an option takes: "FILE", and all others that are paths.
enum class Paths : std::uint8_t { none, files, specs, folders };
Paths paths_of(const OptionHelp& option);

/// "run" of "etlc run".
std::string word_of(const CommandHelp& command);

/// Up to its first sentence's end, on one line.
std::string first_sentence(const std::string& text);

/// Besides its options, etlc takes these words alone.
inline constexpr const char* kOwnWords[] = {"--completion", "--man"};
inline constexpr const char* kShells[] = {"bash", "zsh", "fish"};

}  // namespace etlc::driver
