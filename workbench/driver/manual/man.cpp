// The manual page.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "driver/manual/manual.hpp"

namespace etlc::driver {

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

std::string value_of(const OptionHelp& option) {
    if (!option.words.empty()) return fmt::format("{}", fmt::join(option.words, "|"));
    return option.value;
}

std::string item(const OptionHelp& option) {
    std::string text = ".TP\n";
    std::string names;
    for (const std::string& name : option.names)
        names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", escaped(name));
    const std::string value = value_of(option);
    const std::string shown = value.empty() ? "" : fmt::format("\\fI{}\\fR", escaped(value));
    if (names.empty())
        text += shown;
    else if (option.is_flag && !value.empty())
        text += fmt::format("{}[={}]", names, shown);
    else
        text += names + (shown.empty() ? "" : " " + shown);
    if (option.repeats && !value.ends_with("...")) text += " ...";
    text += "\n" + lines_of(option.text);
    if (!option.usual.empty()) text += fmt::format("(default: {})\n", escaped(option.usual));
    if (option.is_required && !option.names.empty()) text += "(required)\n";
    return text;
}

std::string synopsis(const CommandHelp& command) {
    std::string text = fmt::format(".br\n\\fB{}\\fR", escaped(command.name));
    for (const OptionHelp& option : command.options) {
        if (!option.is_required) continue;
        const std::string name =
            option.names.empty() ? "" : fmt::format("\\fB{}\\fR ", escaped(option.names.back()));
        const bool goes_on = option.repeats && !value_of(option).ends_with("...");
        text +=
            fmt::format(" {}\\fI{}\\fR{}", name, escaped(value_of(option)), goes_on ? " ..." : "");
    }
    return text + " [\\fIoptions\\fR]\n";
}

std::string items(const CommandHelp& command) {
    std::string text;
    for (const OptionHelp& option : command.options) text += item(option);
    return text;
}

}  // namespace

std::string manual_page(const std::vector<CommandHelp>& commands, const std::string& version) {
    const CommandHelp& compiles = commands.front();
    std::string text = fmt::format(
        ".\\\" Made by etlc --man.\n.TH ETLC 1 \"\" \"etlc {}\" \"User Commands\"\n"
        ".SH NAME\netlc \\- compiler for Embedding Temporal Logic\n.SH SYNOPSIS\n",
        version);
    for (const CommandHelp& command : commands) text += synopsis(command);
    text += ".br\n\\fBetlc \\-\\-explain\\fR \\fICODE\\fR\n";
    text += ".br\n\\fBetlc \\-\\-completion bash\\fR\n";
    text += ".br\n\\fBetlc \\-\\-man\\fR\n";
    text += ".SH DESCRIPTION\n" + lines_of(compiles.text.substr(0, compiles.text.find('\n')));
    text += ".SH OPTIONS\n" + items(compiles);
    text +=
        ".TP\n\\fB\\-\\-explain\\fR \\fICODE\\fR\nin place of a spec: what the code of a "
        "diagnostic "
        "means, with an example of its message\n"
        ".TP\n\\fB\\-\\-completion\\fR \\fISHELL\\fR\nin place of a spec: a script that completes "
        "the command line of etlc\n"
        ".TP\n\\fB\\-\\-man\\fR\nin place of a spec: this page\n.SH COMMANDS\n";
    for (const CommandHelp& command : commands)
        if (!word_of(command).empty())
            text += fmt::format(".SS {}\n{}{}", escaped(command.name), lines_of(command.text),
                                items(command));
    constexpr std::string_view kStatus = "Exit status: ";
    const std::string footer = compiles.footer;
    const std::size_t begin = footer.rfind(kStatus, 0) == 0 ? kStatus.size() : 0;
    text += ".SH EXIT STATUS\n" + lines_of(footer.substr(begin));
    text +=
        ".SH SEE ALSO\nThe pages of the documentation: README.md and docs/ of etlc, "
        "which are installed in share/doc/etlc.\n";
    return text;
}

}  // namespace etlc::driver
