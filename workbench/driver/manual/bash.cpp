// The completion script for bash.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "driver/manual/manual.hpp"

namespace etlc::driver {

namespace {

/// Returns the pattern of an option in a case statement: 'run --values' | 'run --values='.
std::string pattern(const CommandHelp& command, const OptionHelp& option) {
    std::vector<std::string> words;
    for (const std::string& name : option.names) {
        if (!option.is_flag) words.push_back(fmt::format("'{} {}'", word_of(command), name));
        if (name.starts_with("--"))
            words.push_back(fmt::format("'{} {}='", word_of(command), name));
    }
    return fmt::format("{}", fmt::join(words, " | "));
}

/// Returns the function that completes the value of an option.
std::string values_of(const OptionHelp& option) {
    if (!option.words.empty()) return fmt::format("_etlc_words '{}'", fmt::join(option.words, " "));
    switch (paths_of(option)) {
        case Paths::specs: return "_etlc_paths '*.etl'";
        case Paths::files: return "_etlc_paths '*'";
        case Paths::folders: return "_etlc_paths ''";
        case Paths::none: break;
    }
    return ":";  // no completion
}

std::string options_of(const CommandHelp& command) {
    std::string words;
    for (const OptionHelp& option : command.options)
        for (const std::string& name : option.names) words += " " + name;
    if (word_of(command).empty())
        for (const char* const own : kOwnWords) words += fmt::format(" {}", own);
    return words.substr(1);
}

/// Returns the pattern of positional arguments: specs, or other files.
const char* positional(const CommandHelp& command) {
    for (const OptionHelp& option : command.options)
        if (option.names.empty()) return paths_of(option) == Paths::specs ? "*.etl" : "*";
    return "";
}

constexpr const char* kFunctions = R"(
# Those of some words, or of the paths that fit a pattern, that go on as the word under the cursor.
_etlc_words() {
    mapfile -t COMPREPLY < <(compgen -W "$1" -- "$current")
}
_etlc_paths() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(
        compgen -d -- "$current"
        [ -z "$1" ] || for path in "$current"*; do
            [[ -f $path && $path == $1 ]] && printf '%s\n' "$path"
        done
    )
}

_etlc() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=''
    # bash takes '--values=b' for three words.
    if [[ $current == '=' ]]; then
        current='' before+='='
    elif [[ $before == '=' ]]; then
        before=${COMP_WORDS[COMP_CWORD - 2]}=
    fi
    COMPREPLY=()
)";

}  // namespace

std::string completion_of_bash(const std::vector<CommandHelp>& commands) {
    std::string values, options, others;
    std::vector<std::string> names;
    for (const CommandHelp& command : commands) {
        const std::string word = word_of(command);
        if (!word.empty()) names.push_back(word);
        for (const OptionHelp& option : command.options)
            if (!option.names.empty() && !(option.is_flag && option.words.empty()))
                values += fmt::format("        {}) {}; return ;;\n", pattern(command, option),
                                      values_of(option));
        options +=
            fmt::format("            '{}') _etlc_words '{}' ;;\n", word, options_of(command));
        others += fmt::format("            '{}') _etlc_paths '{}' ;;\n", word, positional(command));
    }
    std::string text = "# Completion of etlc for bash, made by: etlc --completion bash\n";
    text += kFunctions;
    text +=
        fmt::format("    case ${{COMP_WORDS[1]}} in\n        {}) command=${{COMP_WORDS[1]}} ;;\n",
                    fmt::join(names, " | "));
    text += "    esac\n    case \"$command $before\" in\n" + values;
    text += "        ' --completion') _etlc_words 'bash'; return ;;\n";
    text += "    esac\n    if [[ $current == -* ]]; then\n        case $command in\n" + options +
            "        esac\n        return\n    fi\n    case $command in\n";
    text += others + "    esac\n";
    text += fmt::format(
        "    if ((COMP_CWORD == 1)); then\n"
        "        mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -W '{}' -- \"$current\")\n"
        "    fi\n}}\ncomplete -F _etlc etlc\n",
        fmt::join(names, " "));
    return text;
}

}  // namespace etlc::driver
