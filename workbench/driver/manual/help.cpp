#include "driver/manual/help.hpp"

#include <algorithm>

#include "driver/options/option.hpp"

namespace etlc::driver {

namespace {

/// "-o" and "--output" of "-o,--output"; "--standalone" of "--standalone{portable}"; none of a
/// positional.
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

CommandHelp help_of(Command command, const CommandText& text) {
    CommandHelp help{text.name, text.summary, text.footer, {}};
    for (const Option& option : options())
        if (option.commands.has(command)) help.options.push_back(help_of(option));
    return help;
}

}  // namespace etlc::driver
