// The completion script for zsh.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/manual/manual.hpp"

namespace etlc::driver {

namespace {

/// Escapes text for a quoted argument of _arguments.
std::string zsh_quoted(const std::string& text) {
    std::string result;
    for (const char c : text) {
        if (c == '\'') {
            result += "'\\''";
            continue;
        }
        if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
        result += c;
    }
    return result;
}

std::string action_of(const OptionHelp& option) {
    if (!option.words.empty()) return fmt::format("({})", fmt::join(option.words, " "));
    switch (paths_of(option)) {
        case Paths::specs: return "_files -g \"*.etl\"";
        case Paths::files: return "_files";
        case Paths::folders: return "_files -/";
        case Paths::none: break;
    }
    return " ";
}

/// Returns the arguments of _arguments for an option, one line for each name.
std::string argument(const OptionHelp& option) {
    const std::string what = option.value.empty() ? "word" : option.value;
    const std::string takes = fmt::format(":{}:{}", zsh_quoted(what), action_of(option));
    if (option.names.empty())
        return fmt::format("            '{}{}'\n", option.repeats ? "*" : "", takes);
    std::string text;
    for (const std::string& name : option.names) {
        const std::string times =
            option.repeats ? "*" : fmt::format("({})", fmt::join(option.names, " "));
        const bool behind_sign = option.is_flag && !option.words.empty();
        text += fmt::format("            '{}{}{}[{}]{}'\n", times, name, behind_sign ? "=-" : "",
                            zsh_quoted(first_sentence(option.text)),
                            option.is_flag && !behind_sign ? "" : (behind_sign ? ":" : "") + takes);
    }
    return text;
}

std::string arguments(const CommandHelp& command) {
    std::string text = "        local -a arguments=(\n";
    for (const OptionHelp& option : command.options) text += argument(option);
    if (word_of(command).empty()) {
        text += fmt::format("            '--completion[a script for a shell]:shell:({})'\n",
                            fmt::join(kShells, " "));
        text += "            '--man[the manual page]'\n";
    }
    return text + "        )\n        _arguments $arguments\n";
}

}  // namespace

std::string completion_of_zsh(const std::vector<CommandHelp>& commands) {
    std::string names, branches;
    for (const CommandHelp& command : commands) {
        const std::string word = word_of(command);
        if (word.empty()) continue;
        names += fmt::format("        '{}:{}'\n", word, zsh_quoted(first_sentence(command.text)));
        branches +=
            fmt::format("    {})\n        shift words\n        (( CURRENT-- ))\n{}        ;;\n",
                        word, arguments(command));
    }
    return fmt::format(
        "#compdef etlc\n# Completion of etlc for zsh, made by: etlc --completion zsh\n"
        "_etlc() {{\n    local -a commands=(\n{}    )\n    case $words[2] in\n{}"
        "    *)\n        (( CURRENT == 2 )) && _describe command commands\n{}        ;;\n"
        "    esac\n}}\n_etlc \"$@\"\n",
        names, branches, arguments(commands.front()));
}

}  // namespace etlc::driver
