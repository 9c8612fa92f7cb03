
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "diag/diag.hpp"
#include "driver/options/call.hpp"
#include "driver/options/table.hpp"
#include "driver/process/process.hpp"
#include "library/version.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

constexpr char kHelp[] = "-h,--help";
constexpr char kVersion[] = "--version";

CLI::Option* add_value(CLI::App& app, const Option& option) {
    const Takes& takes = option.takes;
    CLI::Option* added = app.add_option(
        option.names, [](const CLI::results_t&) { return true; }, option.help);
    added->type_name(takes.value)->type_size(1);
    if (takes.repeats) added->expected(CLI::detail::expected_max_vector_size);
    if (takes.once_a_name) added->allow_extra_args(false);
    if (takes.may_be_empty) added->expected(0, takes.repeats ? -1 : 1);
    return added;
}

CLI::Option* add(CLI::App& app, const Option& option) {
    const Takes& takes = option.takes;
    CLI::Option* added =
        takes.is_flag ? app.add_flag(option.names, option.help) : add_value(app, option);
    if (takes.check)
        added->check(
            CLI::Validator([check = takes.check](std::string& found) { return check(found); },
                           fmt::format("{}", fmt::join(takes.choices, "|"))));
    if (!takes.usual.empty()) added->default_str(takes.usual);
    if (option.need == Option::Need::required) added->required();
    return added;
}

/// Prints --help or --version.
int fulfil(const CLI::App& app, const CLI::Success& wish) {
    std::ostringstream text;
    app.exit(wish, text, text);
    return print_text(text.str());
}

}  // namespace

int complain(const std::string& command, const std::string& mistake) {
    print_error(fmt::format("etlc: {}\nRun {} --help for more information.\n",
                            source::visible_lines(mistake), command));
    return kWrongCall;
}

std::optional<int> parse(int argc, char** argv, Call& call) {
    const CommandText text = text_of(call.command);
    call.words.assign(argv, argv + argc);
    CLI::App app(text.summary, text.name);
    app.footer(text.footer);
    std::vector<std::pair<const Option*, CLI::Option*>> all;
    for (const Option& option : options()) {
        if (!option.commands.has(call.command)) continue;
        if (option.names == kHelp)
            app.set_help_flag(kHelp, option.help);
        else if (option.names == kVersion)
            app.set_version_flag(kVersion, fmt::format("etlc {}", library::kVersion), option.help);
        else
            all.emplace_back(&option, add(app, option));
    }
    for (const auto& [option, added] : all) {
        if (!option->excludes.empty()) added->excludes(option->excludes);
        if (!option->needs.empty()) added->needs(app.get_option(option->needs));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& wish) {
        return fulfil(app, wish);
    } catch (const CLI::ParseError& error) {
        return complain(text.name, error.what());
    }
    for (const auto& [option, added] : all) {
        if (added->count() == 0) continue;
        for (const std::string& name : added->get_lnames()) call.given.insert("--" + name);
        const std::string mistake = option->takes.set(call, added->results());
        if (!mistake.empty()) return complain(text.name, mistake);
    }
    if (const std::string mistake = mistake_in(call); !mistake.empty())
        return complain(text.name, mistake);
    return std::nullopt;
}

}  // namespace etlc::driver
