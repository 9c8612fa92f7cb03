#include "driver/options/command_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <sstream>

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

int complain(const CLI::App& app, const std::string& mistake) {
    print_error(fmt::format("etlc: {}\nRun {} --help for more information.\n",
                            source::visible_lines(mistake), app.get_name()));
    return kWrongCall;
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
