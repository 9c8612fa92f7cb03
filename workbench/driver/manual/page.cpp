// The page docs/command_line.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/manual/manual.hpp"

namespace etlc::driver {

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

std::string form_of(const OptionHelp& option) {
    const std::string words = fmt::format("{}", fmt::join(option.words, "|"));
    const std::string& value = option.words.empty() ? option.value : words;
    if (option.names.empty()) return value;
    std::string form = fmt::format("{}", fmt::join(option.names, ", "));
    if (value.empty()) return form;
    return option.is_flag ? fmt::format("{}[={}]", form, value) : fmt::format("{} {}", form, value);
}

std::string row(const OptionHelp& option) {
    std::string text = cell(option.text);
    if (!option.usual.empty()) text += fmt::format(" (default: {})", option.usual);
    if (option.is_required) text += " (required)";
    return fmt::format("| `{}` | {} |\n", cell(form_of(option)), text);
}

constexpr int kSeveral = 3;  ///< so many commands have an option in common

/// Returns the rows of options, each with the number of commands that have it, in the order of the
/// commands.
std::vector<std::pair<std::string, int>> counted(const std::vector<CommandHelp>& commands) {
    std::vector<std::pair<std::string, int>> rows;
    for (const CommandHelp& command : commands)
        for (const OptionHelp& option : command.options) {
            const std::string text = row(option);
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
    const std::string about = command.text.substr(0, command.text.find("\nOther commands:"));
    std::vector<std::string> also;
    std::string own;
    for (const OptionHelp& option : command.options) {
        const std::string text = row(option);
        if (shared.count(text) == 0)
            own += text;
        else
            also.push_back(
                fmt::format("`{}`", option.names.empty() ? option.value : option.names.back()));
    }
    std::string text = fmt::format("\n## {}\n\n{}\n", command.name, wrapped(about));
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

}  // namespace etlc::driver
