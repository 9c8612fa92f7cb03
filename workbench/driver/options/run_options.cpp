#include "driver/options/run_options.hpp"

#include "driver/options/recording_options.hpp"

namespace etlc::driver {

void add_run_options(CLI::App& app, RunRequest& run, check::Options& check) {
    app.add_option("--trace", run.trace,
                   "the trace: .csv, .npz or .h5; FILE.h5:GROUP is the episode in a group of it, "
                   "FOLDER:3 one of a data set; "
                   "- is CSV on standard input, a step as soon as its row is there")
        ->type_name("FILE")
        ->required();
    add_map_option(app, run.names);
    app.add_option("-o,--output", run.output,
                   "where to write the verdicts, as CSV; - is standard output")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_flag("--finish", run.finish,
                 "after the trace, also report the last positions of sliding monitors");
    app.add_flag("--distances", run.distances,
                 "a column for each predicate: the distance or expression that it compares");
    app.add_flag("--lets", check.lets,
                 "a column for each let that does not look ahead: its robustness at that step");
    app.add_flag("--retargetable", check.retargetable,
                 "bounds as a class of --retargetable has them: for any numbers that may come");
    app.add_flag(
        "--summary", run.summary,
        "a line for each monitor, and for inputs with missing samples, on standard output; "
        "the rows are written only where -o says");
    app.add_option("--html", run.html,
                   "also a page of the trace to look at; rows then as with --summary")
        ->type_name("FILE");
    app.add_option("--svg", run.svg, "also a picture of its timelines; rows then as with --summary")
        ->type_name("FILE");
}

std::string mistake_in_run_call(const RunRequest& run) {
    if (run.trace != data::kStandardInput || (run.html.empty() && run.svg.empty())) return "";
    return "--html and --svg read the trace once more, so it cannot be standard input";
}

}  // namespace etlc::driver
