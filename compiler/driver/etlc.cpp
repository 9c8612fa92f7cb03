// The command line. Exit statuses: driver/process.hpp.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "data/files/file.hpp"
#include "data/traces/trace.hpp"
#include "driver/calibrate.hpp"
#include "driver/codes/explain_code.hpp"
#include "driver/compile.hpp"
#include "driver/embed.hpp"
#include "driver/evaluate/evaluate.hpp"
#include "driver/evaluate/options.hpp"
#include "driver/explain/options.hpp"
#include "driver/fit.hpp"
#include "driver/fleet/options.hpp"
#include "driver/incident/incident.hpp"
#include "driver/incident/options.hpp"
#include "driver/language_server.hpp"
#include "driver/manual/manual.hpp"
#include "driver/options/calibrate_options.hpp"
#include "driver/options/command_line.hpp"
#include "driver/options/compile_options.hpp"
#include "driver/options/embed_options.hpp"
#include "driver/options/fit_options.hpp"
#include "driver/options/names.hpp"
#include "driver/options/options.hpp"
#include "driver/options/recording_options.hpp"
#include "driver/options/report_options.hpp"
#include "driver/options/run_options.hpp"
#include "driver/options/spec_options.hpp"
#include "driver/output.hpp"
#include "driver/output_file.hpp"
#include "driver/process.hpp"
#include "driver/run/run.hpp"
#include "driver/with_specs.hpp"
#include "library/open.hpp"
#include "library/version.hpp"
#include "report/page.hpp"

namespace {

using namespace etlc;

constexpr char kExitStatus[] =
    "Exit status: 0, all that was asked for is there; 1, it is not, and a message says why; 2, the "
    "call is wrong; 3, a\n"
    "fault of etlc itself.";

struct Call {
    std::string spec;
    std::vector<std::string> specs;  ///< of evaluate and crossvalidate
    driver::OutputPaths output;
    std::string diagnostics = "text";
    std::vector<std::string> warnings;
    bool check_only = false;
    driver::Request request;
    driver::RunRequest run;
    driver::EmbedRequest embed;
    driver::FitRequest fit;
    driver::CalibrateRequest calibrate;
    driver::EvaluateRequest evaluate;
    driver::ExplainRequest explain;
    driver::ReportRequest report;
    driver::IncidentRequest incident;
};

using driver::SpecWarnings;

template <class Work>
int with_specs(const Call& call, const std::vector<std::string>& paths, SpecWarnings of_spec,
               const Work& work) {
    return driver::with_specs(paths, {call.diagnostics, !call.warnings.empty(), of_spec}, work);
}

/// The same with one spec.
template <class Work>
int with_spec(const Call& call, SpecWarnings of_spec, const Work& work) {
    return with_specs(call, {call.spec}, of_spec,
                      [&](const std::vector<source::File>& files, std::vector<diag::Sink>& sinks) {
                          work(files[0], sinks[0]);
                      });
}

void add_spec_options(CLI::App& app, Call& call, const std::string& spec = "spec") {
    app.add_option(spec, call.spec, "the spec, a .etl file")->type_name("SPEC.etl")->required();
    driver::add_diagnostics_options(app, call.warnings, call.diagnostics);
}

void add_common_options(CLI::App& app, Call& call, const std::string& spec = "spec") {
    add_spec_options(app, call, spec);
    driver::add_compiler_options(app, call.request);
}

/// monitor.targets.bin and monitor.params.bin for monitor.hpp, in the same folder; none for
/// standard output.
void name_files_beside(Call& call) {
    call.output.targets_named = !call.output.targets.empty();
    const std::filesystem::path header = call.output.result;
    const auto beside = [&](const char* ending) {
        return (header.parent_path() / (header.stem().string() + ending)).string();
    };
    if (header != "-") call.output.params = beside(".params.bin");
    if (!call.output.targets_named && header != "-") call.output.targets = beside(".targets.bin");
    call.request.targets_file = std::filesystem::path(call.output.targets).filename().string();
}

/// A line for each.
std::string other_commands();

int compile_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "etlc, the compiler for Embedding Temporal Logic: SPEC.etl in, one C++ monitor class "
        "out.\nOther commands:\n" +
            other_commands() +
            "  etlc --explain CODE\n  etlc --completion bash|zsh|fish\n  etlc --man",
        "etlc");
    app.footer(kExitStatus);
    app.set_version_flag("--version", fmt::format("etlc {}", library::kVersion));
    add_common_options(app, call);
    driver::add_compile_options(app, call.request, call.output, call.check_only);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    if (const std::string mistake =
            driver::mistake_in_compile_call(app, call.request, call.output, call.check_only);
        !mistake.empty())
        return driver::complain(app, mistake);
    if (call.request.explain) call.request.values = check::Values::sourced;
    if (call.request.emit == "params") call.request.check.retargetable = true;
    if (call.output.result.empty()) call.output.result = "-";
    name_files_beside(call);
    call.request.check.allow_missing = call.check_only;
    return with_spec(call, SpecWarnings::told, [&](const source::File& file, diag::Sink& sink) {
        if (call.check_only) {
            driver::compile(file, call.request, sink);
            return;
        }
        const auto output = driver::emit(file, call.request, sink);
        if (output && !sink.refused()) driver::write_output(call.output, file, *output, sink);
    });
}

/// Where it cannot, this has said why.
bool can_make_pages() {
    const std::string missing = report::what_is_missing();
    if (!missing.empty()) driver::print_error(fmt::format("etlc: {}\n", missing));
    return missing.empty();
}

int run_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "Executes a spec's monitors on a recorded trace, without a C++ compiler, in constant "
        "memory.",
        "etlc run");
    add_common_options(app, call);
    driver::add_run_options(app, call.run, call.request.check);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    const bool has_other_output =
        call.run.summary || !call.run.html.empty() || !call.run.svg.empty();
    if (has_other_output && app.count("--output") == 0) call.run.output.clear();
    for (const std::string& mistake : {driver::mistake_in_run_call(call.run),
                                       driver::mistake_in_retargetable_call(app, call.request)})
        if (!mistake.empty()) return driver::complain(app, mistake);
    if (!call.run.html.empty() && !can_make_pages()) return driver::kFailed;
    return with_spec(call, SpecWarnings::dropped, [&](const source::File& file, diag::Sink& sink) {
        const auto compiled = driver::compile(file, call.request, sink);
        if (compiled && !sink.refused()) driver::run(file, *compiled, call.run, sink);
    });
}

int embed_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "Encodes the images and videos that a spec names, into SPEC.embedded.npz beside it, and "
        "recordings into\nepisodes that the other commands take.",
        "etlc embed");
    add_spec_options(app, call);
    driver::add_embed_options(app, call.embed);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    if (const std::string mistake = driver::mistake_in_embed_call(call.embed); !mistake.empty())
        return driver::complain(app, mistake);
    return with_spec(call, SpecWarnings::dropped, [&](const source::File& file, diag::Sink& sink) {
        driver::embed(file, call.embed, sink);
    });
}

int fit_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "Finds the projections, targets and metrics that a spec declares fitted(...) from labelled "
        "demonstrations,\none episode a file, and says how well its predicates then separate.",
        "etlc fit");
    add_spec_options(app, call);
    driver::add_fit_options(app, call.fit);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    driver::read_suggest_option(app, call.fit);
    return with_spec(call, SpecWarnings::dropped,
                     [&](const source::File& file, diag::Sink& sink) {  //
                         driver::fit(file, call.fit, sink);
                     });
}

/// `merged`: all parts of this call; null: the episodes are read.
int calibrate_command(int argc, char** argv, episodes::Sharing* merged = nullptr) {
    Call call;
    CLI::App app(
        "Finds the calibrated thresholds of a spec from labelled demonstrations, one episode a "
        "file.",
        "etlc calibrate");
    add_spec_options(app, call);
    driver::add_calibrate_options(app, call.calibrate);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    const driver::ShardRequest& shard = call.calibrate.shard;
    if (const std::string mistake = driver::mistake_in_shard_call(shard); !mistake.empty())
        return driver::complain(app, mistake);
    auto sharing = driver::sharing_of(shard, {argv, argv + argc});
    call.calibrate.calibration.sharing = sharing ? &*sharing : merged;
    return with_spec(call, SpecWarnings::dropped,
                     [&](const source::File& file, diag::Sink& sink) {  //
                         driver::calibrate(file, call.calibrate, sink);
                     });
}

int evaluate_command(int argc, char** argv, bool crossvalidates,
                     episodes::Sharing* merged = nullptr) {
    Call call;
    CLI::App app(
        crossvalidates
            ? "Calibrates and evaluates specs on the same recorded episodes, in folds: each "
              "episode "
              "is judged\nby monitors that have not seen it."
            : "Compares predicates and monitors of specs with ground truth on recorded episodes.",
        crossvalidates ? "etlc crossvalidate" : "etlc evaluate");
    app.add_option("spec", call.specs, "the specs, .etl files; several are set side by side")
        ->type_name("SPEC.etl")
        ->required();
    driver::add_diagnostics_options(app, call.warnings, call.diagnostics);
    driver::add_compiler_options(app, call.request);
    driver::add_evaluate_options(app, call.evaluate, crossvalidates);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    if (const std::string mistake =
            driver::mistake_in_evaluate_call(app, call.specs, call.evaluate);
        !mistake.empty())
        return driver::complain(app, mistake);
    auto sharing = driver::sharing_of(call.evaluate.shard, {argv, argv + argc});
    call.evaluate.evaluation.sharing = sharing ? &*sharing : merged;
    return with_specs(call, call.specs, SpecWarnings::dropped,
                      [&](const std::vector<source::File>& files, std::vector<diag::Sink>& sinks) {
                          std::vector<driver::SpecToJudge> specs;
                          for (std::size_t i = 0; i < files.size(); ++i)
                              specs.push_back({files[i], sinks[i]});
                          driver::evaluate(specs, call.request, call.evaluate);
                      });
}

int merge_command(int argc, char** argv) {
    Call call;
    std::vector<std::string> paths;
    CLI::App app("Makes of the parts that all shards of a call wrote what the call itself gives.",
                 "etlc merge");
    app.add_option("parts", paths, "the parts, in any order")->type_name("PART...")->required();
    app.add_option("-o,--output", call.output.result,
                   "where the result goes (default: where the call says): thresholds, or JSON")
        ->type_name("FILE");
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    diag::Sink sink;
    auto sharing = driver::read_parts(paths, sink);
    if (!sharing) return driver::conclude(call.diagnostics, source::File(), sink);
    std::vector<std::string> words = driver::merged_call(sharing->part(), call.output.result);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const int count = static_cast<int>(arguments.size());
    if (words[0] == "evaluate") return evaluate_command(count, arguments.data(), false, &*sharing);
    return calibrate_command(count, arguments.data(), &*sharing);
}

int explain_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "Says why a monitor's verdict on a recorded trace is what it is: the samples that it "
        "takes, "
        "the one\nwhose robustness it has, and the smallest change that would turn it.",
        "etlc explain");
    add_common_options(app, call);
    driver::add_explain_options(app, call.explain);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    return with_spec(call, SpecWarnings::dropped, [&](const source::File& file, diag::Sink& sink) {
        const auto compiled = driver::compile(file, call.request, sink);
        if (compiled && !sink.refused()) driver::explain(file, *compiled, call.explain, sink);
    });
}

int report_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "Makes a page to look at: what a spec's monitors say of recorded episodes, why, and where "
        "they are wrong.",
        "etlc report");
    add_common_options(app, call);
    driver::add_report_options(app, call.report);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    if (!can_make_pages()) return driver::kFailed;
    return with_spec(call, SpecWarnings::dropped, [&](const source::File& file, diag::Sink& sink) {
        const auto compiled = driver::compile(file, call.request, sink);
        if (compiled && !sink.refused())
            driver::report(file, *compiled, call.request, call.report, sink);
    });
}

int incident_command(int argc, char** argv) {
    Call call;
    CLI::App app("Prints what the flight recorder of a monitor wrote: the steps around an alarm.",
                 "etlc incident");
    app.add_option("file", call.incident.file, "what write_incident() gave")
        ->type_name("FILE")
        ->required();
    add_common_options(app, call, "--spec");
    driver::add_incident_options(app, call.incident);
    if (const auto status = driver::parse_arguments(app, argc, argv)) return *status;
    return with_spec(call, SpecWarnings::dropped, [&](const source::File& file, diag::Sink& sink) {
        const auto compiled = driver::compile(file, call.request, sink);
        if (compiled && !sink.refused()) driver::incident(file, *compiled, call.incident, sink);
    });
}

struct Command {
    std::string_view name;
    std::string_view takes;  ///< at least; may be empty
    driver::CommandFunction call;
};
constexpr Command kCommands[] = {
    {"run", "SPEC.etl --trace FILE", run_command},
    {"embed", "SPEC.etl --data FILE... -o FOLDER", embed_command},
    {"fit", "SPEC.etl --data FILE...", fit_command},
    {"calibrate", "SPEC.etl --data FILE...",
     [](int argc, char** argv) { return calibrate_command(argc, argv); }},
    {"evaluate", "SPEC.etl... --data FILE...",
     [](int argc, char** argv) { return evaluate_command(argc, argv, false); }},
    {"crossvalidate", "SPEC.etl... --data FILE...",
     [](int argc, char** argv) { return evaluate_command(argc, argv, true); }},
    {"lsp", "", driver::language_server_command},
    {"merge", "PART...", merge_command},
    {"explain", "SPEC.etl --trace FILE", explain_command},
    {"incident", "FILE --spec SPEC.etl", incident_command},
    {"report", "SPEC.etl --data FILE... -o PAGE.html", report_command}};

std::string other_commands() {
    std::string text;
    for (const Command& command : kCommands)
        text += fmt::format("  etlc {}{}{}\n", command.name, command.takes.empty() ? "" : " ",
                            command.takes);
    return text;
}

std::vector<driver::CommandHelp> all_help() {
    std::vector<driver::CommandHelp> all{driver::help_of(compile_command)};
    for (const Command& command : kCommands) all.push_back(driver::help_of(command.call));
    return all;
}

int execute(int argc, char** argv) {
    const std::string_view word = argc > 1 ? argv[1] : "";
    for (const Command& command : kCommands)
        if (command.name == word) return command.call(argc - 1, argv + 1);
    // With a spec it is an option of the class that is made.
    if (word == "--explain" && argc == 3 && driver::is_code(argv[2]))
        return driver::explain_code_command(argv[2]);
    if (word == "--completion" && argc == 3) return driver::completion_command(argv[2], all_help());
    if (word == "--man" && argc == 2) return driver::manual_command(all_help());
    std::vector<std::string> names;
    for (const Command& command : kCommands) names.emplace_back(command.name);
    if (const auto status = driver::check_command(argc, argv, names)) return *status;
    return compile_command(argc, argv);
}

}  // namespace

int main(int argc, char** argv) {
    driver::prepare_process();
    try {
        return driver::go_on_in_ranks(argv) ? execute(argc, argv) : driver::kFailed;
    } catch (...) {
        return driver::say_what_failed();
    }
}
