// The code that the manual page and the completion script share, and the calls that print them.
#include "driver/manual/manual.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "driver/options/call.hpp"
#include "driver/options/mistakes.hpp"
#include "driver/options/option.hpp"
#include "driver/process/output_file.hpp"
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

OptionHelp help_of(const Option& option) {
    const Takes& takes = option.takes;
    OptionHelp help;
    help.names = names_of(option);
    help.value = takes.value;
    help.words = takes.choices;
    help.usual = takes.usual;
    help.text = option.help;
    help.is_flag = takes.is_flag || !takes.set;  // --help and --version set nothing
    help.repeats = takes.repeats;
    help.is_required = option.need == Option::Need::required;
    return help;
}

}  // namespace

std::vector<CommandHelp> all_help() {
    std::vector<CommandHelp> all;
    for (std::size_t i = 0; i < kCommandCount; ++i) {
        const auto command = static_cast<Command>(i);
        CommandText text = text_of(command);
        all.push_back({std::move(text.name), std::move(text.summary), std::move(text.footer), {}});
        for (const Option& option : options())
            if (option.commands.has(command)) all.back().options.push_back(help_of(option));
    }
    return all;
}

Paths paths_of(const OptionHelp& option) {
    const std::string& value = option.value;
    if (value == "SPEC.etl") return Paths::specs;
    if (value == "FOLDER") return Paths::folders;
    for (const char* const path : {"FILE", "PART...", "PATH"})
        if (value.rfind(path, 0) == 0) return Paths::files;
    return Paths::none;
}

std::string word_of(const CommandHelp& command) {
    const std::size_t blank = command.name.find(' ');
    return blank == std::string::npos ? "" : command.name.substr(blank + 1);
}

namespace {

int print_text(const std::string& text) {
    diag::Sink sink;
    print(text, sink);
    return sink.refused() ? kFailed : kDone;
}

}  // namespace

int completion_command(const std::string& shell) {
    const std::string mistake = mistake_in_word(shell, {"bash"});
    if (!mistake.empty()) {
        print_error(fmt::format("etlc: --completion: {}\n", mistake));
        return kWrongCall;
    }
    return print_text(completion_of_bash(all_help()));
}

int manual_command() {
    return print_text(manual_page(all_help(), library::kVersion));
}

}  // namespace etlc::driver
