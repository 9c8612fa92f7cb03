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
#include "driver/options/commands.hpp"
#include "driver/options/mistakes.hpp"
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

/// In the order of Command. `merged`: all parts of this call; null: the episodes are read.
constexpr int (*kFunctions[])(Call& call, episodes::Sharing* merged) = {
    compile,  run,           embed, fit,     calibrate, evaluate,
    evaluate, serve_editors, merge, explain, incident,  report};
static_assert(std::size(kFunctions) == driver::kCommandCount);

int execute(Command command, int argc, char** argv, episodes::Sharing* merged = nullptr) {
    Call call(command);
    if (const auto status = driver::parse(argc, argv, call)) return *status;
    return kFunctions[static_cast<std::size_t>(command)](call, merged);
}

int merge(Call& call, episodes::Sharing*) {
    diag::Sink sink;
    auto sharing = driver::read_parts(call.parts, sink);
    if (!sharing) return driver::conclude(call.diagnostics, source::File(), sink);
    std::vector<std::string> words = driver::merged_call(sharing->part(), call.output.result);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const Command command = words[0] == "evaluate" ? Command::evaluate : Command::calibrate;
    return execute(command, static_cast<int>(arguments.size()), arguments.data(), &*sharing);
}

int execute(int argc, char** argv) {
    const std::string_view word = argc > 1 ? argv[1] : "";
    if (const auto command = driver::command_named(word))
        return execute(*command, argc - 1, argv + 1);
    // With a spec it is an option of the class that is made.
    if (word == "--explain" && argc == 3 && driver::is_code(argv[2]))
        return driver::explain_code_command(argv[2]);
    if (word == "--completion" && argc == 3) return driver::completion_command(argv[2]);
    if (word == "--man" && argc == 2) return driver::manual_command();
    if (const std::string mistake = driver::mistake_in_command(argc, argv); !mistake.empty())
        return driver::complain("etlc", mistake);
    return execute(Command::compile, argc, argv);
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
