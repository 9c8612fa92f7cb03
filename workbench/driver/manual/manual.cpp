// What the pages and the completion script share, and the calls that print them.

#include "driver/manual/manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/options/call.hpp"
#include "driver/options/mistakes.hpp"
#include "driver/options/table.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"

namespace etlc::driver {

namespace {

/// Returns "-o" and "--output" for "-o,--output", "--standalone" for "--standalone{portable}", and
/// nothing for a positional.
std::vector<std::string> names_of(const Option& option) {
    std::vector<std::string> names;
    if (option.names[0] != '-') return names;
    const std::string all = option.names.substr(0, option.names.find('{'));
    for (std::size_t begin = 0; begin <= all.size();) {
        const std::size_t end = std::min(all.find(',', begin), all.size());
        names.push_back(all.substr(begin, end - begin));
        begin = end + 1;
    }
    return names;
}

/// Returns "FILE" or "text|json".
std::string value_of(const Option& option) {
    const Takes& takes = option.takes;
    return takes.choices.empty() ? takes.value : fmt::format("{}", fmt::join(takes.choices, "|"));
}

/// --help and --version set nothing.
bool is_flag(const Option& option) {
    return option.takes.is_flag || !option.takes.set;
}

bool is_required(const Option& option) {
    return option.need == Option::Need::required;
}

struct CommandHelp {
    std::string word;  ///< "run"; empty for etlc without a command
    CommandText text;
    std::vector<const Option*> options;
};

/// Returns the help of all commands, that of etlc itself first.
std::vector<CommandHelp> all_help() {
    std::vector<CommandHelp> all;
    for (std::size_t i = 0; i < kCommandCount; ++i) {
        const auto command = static_cast<Command>(i);
        all.push_back({i == 0 ? "" : command_names()[i - 1], text_of(command), {}});
        for (const Option& option : options())
            if (option.commands.has(command)) all.back().options.push_back(&option);
    }
    return all;
}

}  // namespace

// The page docs/command_line.md.

namespace {

/// Escapes text for a cell of a table; lines that --help indents begin a new line.
std::string cell(const std::string& text) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_not_of(" \n", at), text.size());
        const std::string_view blank = std::string_view(text).substr(at, end - at);
        if (blank.size() > 2 && blank.starts_with('\n'))
            result += "<br>";
        else if (!blank.empty())
            result += ' ';
        if (end == text.size()) break;
        if (text[end] == '|') result += '\\';
        result += text[end];
        at = end + 1;
    }
    return result;
}

/// Breaks text into lines of at most 100 columns.
std::string wrapped(const std::string& text) {
    constexpr std::size_t kColumns = 100;
    std::string result;
    std::size_t column = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find_first_of(" \n", at), text.size());
        const bool breaks = column > 0 && column + 1 + end - at > kColumns;
        if (column > 0) result += breaks ? '\n' : ' ';
        column = (breaks || column == 0 ? 0 : column + 1) + end - at;
        result.append(text, at, end - at);
        at = end + 1;
    }
    return result;
}

std::string form_of(const Option& option) {
    const std::string value = value_of(option);
    const std::vector<std::string> names = names_of(option);
    if (names.empty()) return value;
    const std::string form = fmt::format("{}", fmt::join(names, ", "));
    if (value.empty()) return form;
    return is_flag(option) ? fmt::format("{}[={}]", form, value)
                           : fmt::format("{} {}", form, value);
}

std::string row(const Option& option) {
    std::string text = cell(option.help);
    if (!option.takes.usual.empty()) text += fmt::format(" (default: {})", option.takes.usual);
    if (is_required(option)) text += " (required)";
    return fmt::format("| `{}` | {} |\n", cell(form_of(option)), text);
}

constexpr int kSeveral = 3;  ///< so many commands have an option in common

/// Returns the rows of options, each with the number of commands that have it, in the order of the
/// commands.
std::vector<std::pair<std::string, int>> counted(const std::vector<CommandHelp>& commands) {
    std::vector<std::pair<std::string, int>> rows;
    for (const CommandHelp& command : commands)
        for (const Option* const option : command.options) {
            const std::string text = row(*option);
            const auto same = [&](const auto& other) { return other.first == text; };
            const auto found = std::find_if(rows.begin(), rows.end(), same);
            if (found == rows.end())
                rows.emplace_back(text, 1);
            else
                ++found->second;
        }
    return rows;
}

std::string section(const CommandHelp& command, const std::set<std::string>& shared) {
    const std::string& summary = command.text.summary;
    const std::string about = summary.substr(0, summary.find("\nOther commands:"));
    std::vector<std::string> also;
    std::string own;
    for (const Option* const option : command.options) {
        const std::string text = row(*option);
        const std::vector<std::string> names = names_of(*option);
        if (shared.count(text) == 0)
            own += text;
        else
            also.push_back(fmt::format("`{}`", names.empty() ? option->takes.value : names.back()));
    }
    std::string text = fmt::format("\n## {}\n\n{}\n", command.text.name, wrapped(about));
    if (!own.empty()) text += "\n| option | |\n| --- | --- |\n" + own;
    return text + '\n' + wrapped(fmt::format("Also {}.", fmt::join(also, ", "))) + '\n';
}

}  // namespace

std::string command_line_page() {
    std::string text = R"(# The command line

The options of every command, as `--help` and `man etlc` list them.
This page is made from the table of options; a test keeps the two equal, and `ETLC_UPDATE=1`
rewrites it. [diagnostics.md](diagnostics.md) has the exit statuses.

## Options of several commands

| option | |
| --- | --- |
)";
    const std::vector<CommandHelp> commands = all_help();
    std::set<std::string> shared;
    for (const auto& [line, count] : counted(commands))
        if (count >= kSeveral) text += *shared.insert(line).first;
    for (const CommandHelp& command : commands) text += section(command, shared);
    return text;
}

// The manual page.

namespace {

/// Escapes text for groff: '-' can be copied, and no line is a request.
std::string escaped(const std::string& text) {
    std::string result;
    bool begins_line = true;
    for (const char c : text) {
        if (c == '\\') {
            result += "\\e";
        } else if (c == '-') {
            result += "\\-";
        } else {
            if (begins_line && (c == '.' || c == '\'')) result += "\\&";
            result += c;
        }
        begins_line = c == '\n';
    }
    return result;
}

/// Keeps line breaks and drops indentation, which is for --help.
std::string lines_of(const std::string& text) {
    std::string result;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        const std::size_t first = line.find_first_not_of(' ');
        if (first != std::string::npos) {
            if (!result.empty()) result += first == 0 ? "" : ".br\n";
            result += escaped(line.substr(first)) + "\n";
        }
        begin = end + 1;
    }
    return result;
}

std::string item(const Option& option) {
    std::string text = ".TP\n";
    std::string names;
    for (const std::string& name : names_of(option))
        names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", escaped(name));
    const std::string value = value_of(option);
    const std::string shown = value.empty() ? "" : fmt::format("\\fI{}\\fR", escaped(value));
    if (names.empty())
        text += shown;
    else if (is_flag(option) && !value.empty())
        text += fmt::format("{}[={}]", names, shown);
    else
        text += names + (shown.empty() ? "" : " " + shown);
    if (option.takes.repeats && !value.ends_with("...")) text += " ...";
    text += "\n" + lines_of(option.help);
    const std::string& usual = option.takes.usual;
    if (!usual.empty()) text += fmt::format("(default: {})\n", escaped(usual));
    if (is_required(option) && !names.empty()) text += "(required)\n";
    return text;
}

std::string synopsis(const CommandHelp& command) {
    std::string text = fmt::format(".br\n\\fB{}\\fR", escaped(command.text.name));
    for (const Option* const option : command.options) {
        if (!is_required(*option)) continue;
        const std::vector<std::string> names = names_of(*option);
        const std::string value = value_of(*option);
        const std::string name =
            names.empty() ? "" : fmt::format("\\fB{}\\fR ", escaped(names.back()));
        const bool goes_on = option->takes.repeats && !value.ends_with("...");
        text += fmt::format(" {}\\fI{}\\fR{}", name, escaped(value), goes_on ? " ..." : "");
    }
    return text + " [\\fIoptions\\fR]\n";
}

std::string items(const CommandHelp& command) {
    std::string text;
    for (const Option* const option : command.options) text += item(*option);
    return text;
}

std::string manual_page(const std::vector<CommandHelp>& commands) {
    const CommandText& compiles = commands.front().text;
    std::string text = fmt::format(
        ".\\\" Made by etlc --man.\n.TH ETLC 1 \"\" \"etlc {}\" \"User Commands\"\n"
        ".SH NAME\netlc \\- compiler for Embedding Temporal Logic\n.SH SYNOPSIS\n",
        library::kVersion);
    for (const CommandHelp& command : commands) text += synopsis(command);
    text += ".br\n\\fBetlc \\-\\-explain\\fR \\fICODE\\fR\n";
    text += ".br\n\\fBetlc \\-\\-completion bash\\fR\n";
    text += ".br\n\\fBetlc \\-\\-man\\fR\n";
    text += ".SH DESCRIPTION\n" + lines_of(compiles.summary.substr(0, compiles.summary.find('\n')));
    text += ".SH OPTIONS\n" + items(commands.front());
    text +=
        ".TP\n\\fB\\-\\-explain\\fR \\fICODE\\fR\nin place of a spec: what the code of a "
        "diagnostic "
        "means, with an example of its message\n"
        ".TP\n\\fB\\-\\-completion\\fR \\fISHELL\\fR\nin place of a spec: a script that completes "
        "the command line of etlc\n"
        ".TP\n\\fB\\-\\-man\\fR\nin place of a spec: this page\n.SH COMMANDS\n";
    for (const CommandHelp& command : commands)
        if (!command.word.empty())
            text += fmt::format(".SS {}\n{}{}", escaped(command.text.name),
                                lines_of(command.text.summary), items(command));
    constexpr std::string_view kStatus = "Exit status: ";
    text += ".SH EXIT STATUS\n" + lines_of(compiles.footer.substr(kStatus.size()));
    text +=
        ".SH SEE ALSO\nThe pages of the documentation: README.md and docs/ of etlc, "
        "which are installed in share/doc/etlc.\n";
    return text;
}

}  // namespace

int manual_command() {
    return print_text(manual_page(all_help()));
}

// The completion script for bash.

namespace {

/// Returns the pattern of an option in a case statement: 'run --values' | 'run --values='.
std::string pattern(const CommandHelp& command, const Option& option) {
    std::vector<std::string> words;
    for (const std::string& name : names_of(option)) {
        if (!is_flag(option)) words.push_back(fmt::format("'{} {}'", command.word, name));
        if (name.starts_with("--")) words.push_back(fmt::format("'{} {}='", command.word, name));
    }
    return fmt::format("{}", fmt::join(words, " | "));
}

/// Returns the pattern of the files that an option takes, empty for folders; nothing for no paths.
std::optional<std::string> paths_of(const Option& option) {
    const std::string& value = option.takes.value;
    if (value == "SPEC.etl") return "*.etl";
    if (value == "FOLDER") return "";
    for (const char* const path : {"FILE", "PART...", "PATH"})
        if (value.starts_with(path)) return "*";
    return std::nullopt;
}

/// Returns the function that completes the value of an option.
std::string values_of(const Option& option) {
    const Takes::Words& words = option.takes.choices;
    if (!words.empty()) return fmt::format("_etlc_words '{}'", fmt::join(words, " "));
    const auto paths = paths_of(option);
    return paths ? fmt::format("_etlc_paths '{}'", *paths) : ":";  // no completion
}

std::string options_of(const CommandHelp& command) {
    std::string words;
    for (const Option* const option : command.options)
        for (const std::string& name : names_of(*option)) words += " " + name;
    if (command.word.empty()) words += " --completion --man";  // which are not in the table
    return words.substr(1);
}

/// Returns the pattern of positional arguments: specs, or other files.
std::string positional(const CommandHelp& command) {
    for (const Option* const option : command.options)
        if (names_of(*option).empty()) return paths_of(*option).value_or("*");
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

std::string completion_of_bash(const std::vector<CommandHelp>& commands) {
    std::string values, options, others;
    std::vector<std::string> names;
    for (const CommandHelp& command : commands) {
        const std::string& word = command.word;
        if (!word.empty()) names.push_back(word);
        for (const Option* const option : command.options)
            if (!names_of(*option).empty() && !(is_flag(*option) && option->takes.choices.empty()))
                values += fmt::format("        {}) {}; return ;;\n", pattern(command, *option),
                                      values_of(*option));
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

}  // namespace

int completion_command(const std::string& shell) {
    const std::string mistake = mistake_in_word(shell, {"bash"});
    if (mistake.empty()) return print_text(completion_of_bash(all_help()));
    print_error(fmt::format("etlc: --completion: {}\n", mistake));
    return kWrongCall;
}

// The table of options as a module of the Python package: python/etlc/_options.py.

namespace {

/// Returns how the values of an option stand in a call.
std::string_view manner_of(const Option& option) {
    const Takes& takes = option.takes;
    if (option.names[0] != '-') return "positional";
    if (takes.may_be_empty) return "any";
    if (takes.is_flag) return takes.choices.empty() ? "flag" : "word";
    return takes.repeats ? "several" : "one";
}

}  // namespace

std::string python_options() {
    std::string text = R"("""The options of the commands of etlc.

This module is made from the table of options of the command line; a test keeps the two equal, and
ETLC_UPDATE=1 rewrites it.
"""

from __future__ import annotations

from typing import Literal, NamedTuple


class Option(NamedTuple):
    """An option: its name, the form of its value, and how values stand in a call.

    positional: without the name. flag: without a value. word: without a value, or with one behind
    "=". one: with a value. several: with one or more. any: with any number of them.
    """

    name: str
    value: str
    manner: Literal["positional", "flag", "word", "one", "several", "any"]


#: The options of each command, without those that only print help.
OPTIONS: dict[str, tuple[Option, ...]] = {
)";
    for (const CommandHelp& command : all_help()) {
        text += fmt::format("    \"{}\": (\n", command.word.empty() ? "compile" : command.word);
        for (const Option* const option : command.options) {
            if (!option->takes.set) continue;
            const std::vector<std::string> names = names_of(*option);
            text += fmt::format("        Option(\"{}\", \"{}\", \"{}\"),\n",
                                names.empty() ? option->names : names.back(), option->takes.value,
                                manner_of(*option));
        }
        text += "    ),\n";
    }
    return text + "}\n";
}

}  // namespace etlc::driver
