#include "driver/manual/help.hpp"

#include <algorithm>
#include <utility>

#include "driver/options/commands.hpp"
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

}  // namespace etlc::driver
