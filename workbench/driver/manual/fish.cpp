// The completion script for fish.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/manual/manual.hpp"

namespace etlc::driver {

namespace {

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') result += '\\';
        result += c;
    }
    return result + "'";
}

std::string fish_values(const OptionHelp& option) {
    if (option.is_flag && option.words.empty()) return "";
    if (!option.words.empty()) {
        // The value of a flag is optional.
        const char* const needs = option.is_flag ? "-f" : "-x";
        return fmt::format(" {} -a '{}'", needs, fmt::join(option.words, " "));
    }
    switch (paths_of(option)) {
        case Paths::specs: return " -x -a '(__fish_complete_suffix .etl)'";
        case Paths::files: return " -r -F";
        case Paths::folders: return " -x -a '(__fish_complete_directories)'";
        case Paths::none: break;
    }
    return " -x";
}

}  // namespace

std::string completion_of_fish(const std::vector<CommandHelp>& commands) {
    std::vector<std::string> names;
    for (const CommandHelp& command : commands)
        if (!word_of(command).empty()) names.push_back(word_of(command));
    const std::string none =
        fmt::format("'not __fish_seen_subcommand_from {}'", fmt::join(names, " "));
    std::string text = "# Completion of etlc for fish, made by: etlc --completion fish\n";
    for (const CommandHelp& command : commands) {
        const std::string word = word_of(command);
        const std::string where =
            word.empty() ? none : fmt::format("'__fish_seen_subcommand_from {}'", word);
        if (!word.empty())
            text += fmt::format("complete -c etlc -n {} -a {} -d {}\n", none, word,
                                quoted(first_sentence(command.text)));
        for (const OptionHelp& option : command.options) {
            if (option.names.empty()) continue;
            std::string spelt;
            for (const std::string& name : option.names)
                spelt += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
            text += fmt::format("complete -c etlc -n {}{}{} -d {}\n", where, spelt,
                                fish_values(option), quoted(first_sentence(option.text)));
        }
    }
    text += fmt::format(
        "complete -c etlc -n {0} -l completion -x -a '{1}' -d 'a script for a shell'\n"
        "complete -c etlc -n {0} -l man -d 'the manual page'\n",
        none, fmt::join(kShells, " "));
    return text;
}

}  // namespace etlc::driver
