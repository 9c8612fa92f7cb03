#include "driver/explain/options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "data/quote.hpp"
#include "driver/options/options.hpp"
#include "driver/options/recording_options.hpp"

namespace etlc::driver {

namespace {

std::optional<double> seconds(const std::string& text) {
    double number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    const bool is_time =
        error == std::errc() && stop == end && std::isfinite(number) && number >= 0;
    return is_time ? std::optional(number) : std::nullopt;
}

std::string mistake_in_time(const std::string& found) {
    if (seconds(found)) return "";
    return fmt::format("found {}, expected a number of seconds from 0", data::in_quotes(found));
}

}  // namespace

void add_explain_options(CLI::App& app, ExplainRequest& request) {
    app.add_option("--trace", request.trace,
                   "the trace: .csv, .npz or .h5; FILE.h5:GROUP is the episode in a group of it, "
                   "FOLDER:3 one of a data set")
        ->type_name("FILE")
        ->required();
    add_map_option(app, request.names);
    app.add_option("--monitor", request.monitor,
                   "which (default: the first that raises an alarm, else the first)")
        ->type_name("NAME");
    auto* step = add_number(app, "--step", request.step,
                            "the verdict after this step (default: after that of the first "
                            "alarm, else the first that is final, else the last); of a sliding "
                            "monitor also steps after the trace, as etlc run --finish has them",
                            0, std::numeric_limits<std::uint32_t>::max());
    app.add_option_function<std::string>(
           "--at", [&request](const std::string& text) { request.at = seconds(text); },
           "the same in seconds, to the nearest step")
        ->type_name("SECONDS")
        ->check(CLI::Validator(mistake_in_time, ""))
        ->excludes(step);
    add_choice<ExplanationFormat>(
        app, "--format", request.format,
        {{"text", ExplanationFormat::text}, {"json", ExplanationFormat::json}},
        "for people, or for programs");
    app.add_option("-o,--output", request.output, "where to write it; - is standard output")
        ->type_name("FILE")
        ->capture_default_str();
}

}  // namespace etlc::driver
