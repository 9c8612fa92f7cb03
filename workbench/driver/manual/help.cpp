#include "driver/manual/help.hpp"

#include <algorithm>
#include <cassert>

namespace etlc::driver {

namespace {

/// Known by its place, so that no argument of a user is it.
char asked[] = "--help";

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> words;
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(at, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

/// CLI11 says "FILE", or ":f32|f16" of one of some words.
void take_type(const std::string& type, OptionHelp& option) {
    const std::size_t colon = type.find(':');
    if (colon == std::string::npos)
        option.value = type;
    else
        option.words = split(type.substr(colon + 1), '|');
}

OptionHelp help_of(const CLI::Option& option) {
    OptionHelp help;
    for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
    help.is_flag = !option.get_positional() && option.get_expected_min() == 0;
    if (!help.is_flag || option.get_type_name().find(':') != std::string::npos)
        take_type(option.get_type_name(), help);
    help.usual = option.get_default_str();
    help.text = option.get_description();
    help.repeats = option.get_items_expected_max() > 1;
    help.is_required = option.get_required();
    return help;
}

}  // namespace

CommandHelp help_of(CommandFunction command) {
    char name[] = "etlc";
    char* arguments[] = {name, asked, nullptr};
    try {
        command(2, arguments);
    } catch (CommandHelp& help) {
        return std::move(help);
    }
    assert(false && "the command has not called parse_arguments()");
    return {};
}

void tell_help(const CLI::App& app, int argc, char** argv) {
    if (argc != 2 || argv[1] != asked) return;
    CommandHelp help{app.get_name(), app.get_description(), app.get_footer(), {}};
    for (const CLI::Option* option : app.get_options()) help.options.push_back(help_of(*option));
    throw help;
}

}  // namespace etlc::driver
