#include "driver/options/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>

#include "data/quote.hpp"
#include "diag/render.hpp"
#include "driver/manual/help.hpp"
#include "driver/output.hpp"
#include "driver/output_file.hpp"
#include "driver/process.hpp"
#include "library/version.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

int conclude(const std::string& form, const source::File& file, const diag::Sink& sink) {
    const auto colour = isatty(STDERR_FILENO) != 0 ? diag::Colour::ansi : diag::Colour::none;
    const bool json = form == "json";
    const bool told =
        print_error(json ? diag::render_json(file, sink) : diag::render_text(file, sink, colour));
    return sink.refused() || !told ? kFailed : kDone;
}

namespace {

int complain(const std::string& command, const std::string& mistake) {
    print_error(fmt::format("etlc: {}\nRun {} --help for more information.\n",
                            source::visible_lines(mistake), command));
    return kWrongCall;
}

}  // namespace

int complain(const CLI::App& app, const std::string& mistake) {
    return complain(app.get_name(), mistake);
}

std::optional<int> check_command(int argc, char** argv, const std::vector<std::string>& commands) {
    const std::string word = argc > 1 ? argv[1] : "";
    const bool is_path = word.find_first_of("./\\") != word.npos;
    std::error_code ignored;
    if (word.empty() || word[0] == '-' || is_path || std::filesystem::exists(word, ignored))
        return std::nullopt;
    const std::string no_command = fmt::format("there is no command {}", data::in_quotes(word));
    if (word == "help" || word == "version")
        return complain("etlc", fmt::format("{}; did you mean '--{}'?", no_command, word));
    if (const auto near = diag::nearest_name(word, commands))
        return complain("etlc", fmt::format("{}; did you mean '{}'?", no_command, *near));
    if (argc == 2 || argv[2][0] == '-') return std::nullopt;
    return complain("etlc", fmt::format("{}; the commands are {}; etlc SPEC.etl compiles a spec",
                                        no_command, fmt::join(commands, ", ")));
}

namespace {

/// --help, --version
int fulfil(const CLI::App& app, const CLI::Success& wish) {
    std::ostringstream text;
    app.exit(wish, text, text);
    diag::Sink sink;
    print(text.str(), sink);
    return conclude("text", source::File(), sink);
}

}  // namespace

std::optional<int> parse_arguments(CLI::App& app, int argc, char** argv) {
    tell_help(app, argc, argv);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& wish) {  // --help, --version
        return fulfil(app, wish);
    } catch (const CLI::ParseError& error) {
        return complain(app, error.what());
    }
    return std::nullopt;
}

}  // namespace etlc::driver
