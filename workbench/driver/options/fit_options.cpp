#include "driver/options/fit_options.hpp"

#include "driver/options/recording_options.hpp"
#include "driver/options/spec_options.hpp"

namespace etlc::driver {

void add_fit_options(CLI::App& app, FitRequest& request) {
    add_set_option(app, request.settings);
    add_episode_options(app, request.data, request.groups, request.fit.allow_overlap,
                        request.fit.jobs);
    add_map_option(app, request.fit.names);
    add_embedded_option(app, request.embedded);
    app.add_option("-o,--output", request.output,
                   "where to write what is fitted (default: SPEC.fitted.npz beside the spec); "
                   "- is standard output")
        ->type_name("FILE");
    CLI::Option* suggest =
        app.add_option("--suggest", request.predicates,
                       "try distances, targets and projections for these predicates (default: all "
                       "with labels) and print\nhow well each separates, with the lines to paste; "
                       "nothing is written")
            ->type_name("[PREDICATE...]")
            ->expected(0, -1)
            ->excludes("--output");
    app.add_flag("--json", request.json, "with --suggest: for programs")->needs(suggest);
}

void read_suggest_option(const CLI::App& app, FitRequest& request) {
    request.suggest = app.count("--suggest") > 0;
    std::erase(request.predicates, "");  // what CLI11 makes of none
}

}  // namespace etlc::driver
