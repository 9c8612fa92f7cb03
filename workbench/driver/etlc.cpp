// The commands. Exit statuses: driver/process/process.hpp.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "driver/codes/explain_code.hpp"
#include "driver/manual/manual.hpp"
#include "driver/options/parse.hpp"
#include "driver/process/output_file.hpp"
#include "driver/process/process.hpp"
#include "driver/process/with_specs.hpp"
#include "lsp/lsp.hpp"
#include "report/page.hpp"

namespace {

using namespace etlc;
using driver::Call;
using driver::Command;
using driver::SpecWarnings;

template <class Work>
int with_specs(const Call& call, SpecWarnings of_spec, const Work& work) {
    return driver::with_specs(call.specs, {call.diagnostics, !call.warnings.empty(), of_spec},
                              work);
}

/// The same with one spec, whose warnings the command that compiles it tells.
template <class Work>
int with_spec(const Call& call, const Work& work, SpecWarnings of_spec = SpecWarnings::dropped) {
    return with_specs(call, of_spec,
                      [&](const std::vector<source::File>& files, std::vector<diag::Sink>& sinks) {
                          work(files[0], sinks[0]);
                      });
}

/// With the spec's plan.
template <class Work>
int with_plan(const Call& call, const Work& work) {
    return with_spec(call, [&](const source::File& file, diag::Sink& sink) {
        const auto compiled = driver::compile(file, call.request, sink);
        if (compiled && !sink.refused()) work(file, *compiled, sink);
    });
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

int compile(Call& call, episodes::Sharing*) {
    if (call.request.explain) call.request.values = check::Values::sourced;
    if (call.request.emit == "params") call.request.check.retargetable = true;
    if (call.output.result.empty()) call.output.result = "-";
    name_files_beside(call);
    call.request.check.allow_missing = call.check_only;
    const auto work = [&](const source::File& file, diag::Sink& sink) {
        if (call.check_only) {
            driver::compile(file, call.request, sink);
            return;
        }
        const auto output = driver::emit(file, call.request, sink);
        if (output && !sink.refused()) driver::write_output(call.output, file, *output, sink);
    };
    return with_spec(call, work, SpecWarnings::told);
}

/// Where it cannot, this has said why.
bool can_make_pages() {
    const std::string missing = report::what_is_missing();
    if (!missing.empty()) driver::print_error(fmt::format("etlc: {}\n", missing));
    return missing.empty();
}

int run(Call& call, episodes::Sharing*) {
    const bool has_other_output =
        call.run.summary || !call.run.html.empty() || !call.run.svg.empty();
    if (has_other_output && !call.has("--output")) call.run.output.clear();
    if (!call.run.html.empty() && !can_make_pages()) return driver::kFailed;
    return with_plan(call, [&](const source::File& file, const driver::Compiled& compiled,
                               diag::Sink& sink) { driver::run(file, compiled, call.run, sink); });
}

int embed(Call& call, episodes::Sharing*) {
    return with_spec(call, [&](const source::File& file, diag::Sink& sink) {
        driver::embed(file, call.embed, sink);
    });
}

int fit(Call& call, episodes::Sharing*) {
    return with_spec(call, [&](const source::File& file, diag::Sink& sink) {
        driver::fit(file, call.fit, sink);
    });
}

/// `merged`: all parts of this call; null: the episodes are read.
int calibrate(Call& call, episodes::Sharing* merged) {
    auto sharing = driver::sharing_of(call.calibrate.shard, call.words);
    call.calibrate.calibration.sharing = sharing ? &*sharing : merged;
    return with_spec(call, [&](const source::File& file, diag::Sink& sink) {
        driver::calibrate(file, call.calibrate, sink);
    });
}

int evaluate(Call& call, episodes::Sharing* merged) {
    auto sharing = driver::sharing_of(call.evaluate.shard, call.words);
    call.evaluate.evaluation.sharing = sharing ? &*sharing : merged;
    return with_specs(call, SpecWarnings::dropped,
                      [&](const std::vector<source::File>& files, std::vector<diag::Sink>& sinks) {
                          std::vector<driver::SpecToJudge> specs;
                          for (std::size_t i = 0; i < files.size(); ++i)
                              specs.push_back({files[i], sinks[i]});
                          driver::evaluate(specs, call.request, call.evaluate);
                      });
}

int serve_editors(Call&, episodes::Sharing*) {
    return lsp::serve(STDIN_FILENO, STDOUT_FILENO);
}

int merge(Call& call, episodes::Sharing*);

int explain(Call& call, episodes::Sharing*) {
    return with_plan(
        call, [&](const source::File& file, const driver::Compiled& compiled, diag::Sink& sink) {
            driver::explain(file, compiled, call.explain, sink);
        });
}

int incident(Call& call, episodes::Sharing*) {
    return with_plan(
        call, [&](const source::File& file, const driver::Compiled& compiled, diag::Sink& sink) {
            driver::incident(file, compiled, call.incident, sink);
        });
}

int report(Call& call, episodes::Sharing*) {
    if (!can_make_pages()) return driver::kFailed;
    return with_plan(
        call, [&](const source::File& file, const driver::Compiled& compiled, diag::Sink& sink) {
            driver::report(file, compiled, call.request, call.report, sink);
        });
}

struct Row {
    Command command;
    std::string_view name;   ///< empty: etlc without a command
    std::string_view takes;  ///< at least; may be empty
    std::string_view summary;
    int (*execute)(Call& call, episodes::Sharing* merged);
};
constexpr Row kCommands[] = {
    {Command::compile, "", "", "", compile},
    {Command::run, "run", "SPEC.etl --trace FILE",
     "Executes a spec's monitors on a recorded trace, without a C++ compiler, in constant memory.",
     run},
    {Command::embed, "embed", "SPEC.etl --data FILE... -o FOLDER",
     "Encodes the images and videos that a spec names, into SPEC.embedded.npz beside it, and "
     "recordings into\nepisodes that the other commands take.",
     embed},
    {Command::fit, "fit", "SPEC.etl --data FILE...",
     "Finds the projections, targets and metrics that a spec declares fitted(...) from labelled "
     "demonstrations,\none episode a file, and says how well its predicates then separate.",
     fit},
    {Command::calibrate, "calibrate", "SPEC.etl --data FILE...",
     "Finds the calibrated thresholds of a spec from labelled demonstrations, one episode a file.",
     calibrate},
    {Command::evaluate, "evaluate", "SPEC.etl... --data FILE...",
     "Compares predicates and monitors of specs with ground truth on recorded episodes.", evaluate},
    {Command::crossvalidate, "crossvalidate", "SPEC.etl... --data FILE...",
     "Calibrates and evaluates specs on the same recorded episodes, in folds: each episode is "
     "judged\nby monitors that have not seen it.",
     evaluate},
    {Command::lsp, "lsp", "",
     "The language server, for editors: it speaks the Language Server Protocol on standard input "
     "and output.\ndocs/editors.md says how editors start it.",
     serve_editors},
    {Command::merge, "merge", "PART...",
     "Makes of the parts that all shards of a call wrote what the call itself gives.", merge},
    {Command::explain, "explain", "SPEC.etl --trace FILE",
     "Says why a monitor's verdict on a recorded trace is what it is: the samples that it takes, "
     "the one\nwhose robustness it has, and the smallest change that would turn it.",
     explain},
    {Command::incident, "incident", "FILE --spec SPEC.etl",
     "Prints what the flight recorder of a monitor wrote: the steps around an alarm.", incident},
    {Command::report, "report", "SPEC.etl --data FILE... -o PAGE.html",
     "Makes a page to look at: what a spec's monitors say of recorded episodes, why, and where "
     "they are wrong.",
     report}};
static_assert(std::size(kCommands) == driver::kCommandCount);

driver::CommandText text_of(const Row& row) {
    if (!row.name.empty()) return {fmt::format("etlc {}", row.name), std::string(row.summary), ""};
    std::string summary =
        "etlc, the compiler for Embedding Temporal Logic: SPEC.etl in, one C++ monitor class "
        "out.\nOther commands:\n";
    for (const Row& other : kCommands)
        if (!other.name.empty())
            summary += fmt::format("  etlc {}{}{}\n", other.name, other.takes.empty() ? "" : " ",
                                   other.takes);
    summary += "  etlc --explain CODE\n  etlc --completion bash|zsh|fish\n  etlc --man";
    return {"etlc", summary,
            "Exit status: 0, all that was asked for is there; 1, it is not, and a message says "
            "why; 2, the call is wrong; 3, a\nfault of etlc itself."};
}

int execute(const Row& row, int argc, char** argv, episodes::Sharing* merged = nullptr) {
    Call call(row.command);
    if (const auto status = driver::parse(text_of(row), argc, argv, call)) return *status;
    return row.execute(call, merged);
}

const Row& row_of(Command command) {
    return kCommands[static_cast<std::size_t>(command)];
}

int merge(Call& call, episodes::Sharing*) {
    diag::Sink sink;
    auto sharing = driver::read_parts(call.parts, sink);
    if (!sharing) return driver::conclude(call.diagnostics, source::File(), sink);
    std::vector<std::string> words = driver::merged_call(sharing->part(), call.output.result);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const Command command = words[0] == "evaluate" ? Command::evaluate : Command::calibrate;
    return execute(row_of(command), static_cast<int>(arguments.size()), arguments.data(),
                   &*sharing);
}

std::vector<driver::CommandHelp> all_help() {
    std::vector<driver::CommandHelp> all;
    for (const Row& row : kCommands) all.push_back(driver::help_of(row.command, text_of(row)));
    return all;
}

int execute(int argc, char** argv) {
    const std::string_view word = argc > 1 ? argv[1] : "";
    for (const Row& row : kCommands)
        if (!row.name.empty() && row.name == word) return execute(row, argc - 1, argv + 1);
    // With a spec it is an option of the class that is made.
    if (word == "--explain" && argc == 3 && driver::is_code(argv[2]))
        return driver::explain_code_command(argv[2]);
    if (word == "--completion" && argc == 3) return driver::completion_command(argv[2], all_help());
    if (word == "--man" && argc == 2) return driver::manual_command(all_help());
    return execute(row_of(Command::compile), argc, argv);
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
