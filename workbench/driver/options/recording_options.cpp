#include "driver/options/recording_options.hpp"

#include <utility>

#include "driver/options/names.hpp"
#include "driver/options/options.hpp"

namespace etlc::driver {

void add_map_option(CLI::App& app, data::NamesInFile& names) {
    const auto read = [&names](const std::vector<std::string>& words) {
        std::string mistake;
        auto parsed = parse_names(words, mistake);
        if (!parsed) throw CLI::ValidationError(mistake);
        names = std::move(*parsed);
    };
    app.add_option_function<std::vector<std::string>>(
           "--map", read, "what an input is called in the files: --map z=obs/z")
        ->type_name("NAME=OTHER");
}

void add_episode_options(CLI::App& app, std::vector<std::string>& data, std::string& groups,
                         std::string& allow_overlap, unsigned& jobs) {
    app.add_option(
           "--data", data,
           "episodes: files (" + data::trace_endings() + "), folders, data sets, 'patterns'")
        ->type_name("FILE...")
        ->required();
    app.add_option("--episodes", groups, "groups of .h5 files that are episodes: 'data/*'")
        ->type_name("PATTERN");
    app.add_option(
           "--allow-overlap", allow_overlap,
           "why episodes may share most of their content, or hold targets, and still count; "
           "it is written into the result")
        ->type_name("REASON")
        ->check(CLI::Validator(mistake_in_reason, ""));
    add_number(app, "-j,--jobs", jobs, "threads (default: as many as the machine has)", 1, 1024);
}

void add_folds_option(CLI::App& app, std::uint32_t& folds, const std::string& help) {
    add_number(app, "--folds", folds, help, 2, 1000);
}

}  // namespace etlc::driver
