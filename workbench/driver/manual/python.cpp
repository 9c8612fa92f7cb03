// The table of options as a module of the Python package: python/etlc/_options.py.
#include <fmt/format.h>

#include <cstddef>
#include <string_view>

#include "driver/manual/manual.hpp"
#include "driver/options/call.hpp"
#include "driver/options/option.hpp"

namespace etlc::driver {

namespace {

/// Returns how the values of an option stand in a call.
std::string_view manner_of(const Option& option) {
    const Takes& takes = option.takes;
    if (option.names[0] != '-') return "positional";
    if (takes.may_be_empty) return "any";
    if (takes.is_flag) return takes.choices.empty() ? "flag" : "word";
    return takes.repeats ? "several" : "one";
}

/// Returns "--output" for "-o,--output" and "--standalone" for "--standalone{portable}".
std::string long_name(const Option& option) {
    const std::string all = option.names.substr(0, option.names.find('{'));
    return all.substr(all.find(',') + 1);
}

/// Returns "run"; "compile" for etlc without a command.
std::string name_of(Command command) {
    const std::string name = text_of(command).name;
    const std::size_t blank = name.find(' ');
    return blank == std::string::npos ? "compile" : name.substr(blank + 1);
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
    for (std::size_t i = 0; i < kCommandCount; ++i) {
        const auto command = static_cast<Command>(i);
        text += fmt::format("    \"{}\": (\n", name_of(command));
        for (const Option& option : options())
            if (option.takes.set && option.commands.has(command))
                text += fmt::format("        Option(\"{}\", \"{}\", \"{}\"),\n", long_name(option),
                                    option.takes.value, manner_of(option));
        text += "    ),\n";
    }
    return text + "}\n";
}

}  // namespace etlc::driver
