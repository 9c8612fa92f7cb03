// The program etlc: which command a call means, and how its findings are printed.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "compile.hpp"
#include "data/files/file.hpp"
#include "diag/diag.hpp"
#include "driver/codes/explain_code.hpp"
#include "driver/commands/commands.hpp"
#include "driver/manual/manual.hpp"
#include "driver/options/call.hpp"
#include "driver/options/mistakes.hpp"
#include "driver/process/process.hpp"
#include "label/service.hpp"
#include "lsp/lsp.hpp"
#include "report/document.hpp"
#include "source/source.hpp"

namespace etlc::driver {

namespace {

/// Reads the specs, calls `work(files, sinks)`, and prints the findings, also where memory runs
/// out. Only the command that compiles a spec prints the warnings about it.
template <class Work>
int with_specs(const Call& call, const Work& work) {
    std::vector<diag::Sink> sinks(call.specs.size(), diag::Sink(!call.warnings.empty()));
    std::vector<source::File> files(call.specs.size());
    const auto report_lack = [&] {
        sinks[0].report(data::in_file(
            {diag::Code::out_of_memory, "there is not enough memory for this"}, call.specs[0]));
    };
    try {
        bool all_read = true;
        for (std::size_t i = 0; i < files.size(); ++i)
            all_read = read_spec(call.specs[i], files[i], sinks[i]) && all_read;
        if (all_read) work(files, sinks);
    } catch (const std::bad_alloc&) {
        report_lack();
    } catch (const std::length_error&) {
        report_lack();
    }
    int status = kDone;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (call.command != Command::compile) sinks[i].drop_warnings_of_spec();
        status = std::max(status, conclude(call.diagnostics, files[i], sinks[i]));
    }
    return status;
}

/// Calls `work(file, sink)` with the one spec of the call.
template <class Work>
int with_spec(const Call& call, const Work& work) {
    return with_specs(call, [&](const auto& files, auto& sinks) { work(files[0], sinks[0]); });
}

/// A command that reads the text of a spec.
template <auto work>
int on_spec(Call& call) {
    return with_spec(call,
                     [&](const source::File& file, diag::Sink& sink) { work(file, call, sink); });
}

/// A command that needs the plan of a spec.
template <auto work>
int on_plan(Call& call) {
    return with_spec(call, [&](const source::File& file, diag::Sink& sink) {
        const auto compiled = compile(file, call.check, call, sink);
        if (compiled && !sink.refused()) work(file, *compiled, call, sink);
    });
}

int compile_spec(Call& call) {
    call.check.allow_missing = call.check_only;
    return with_spec(call, [&](const source::File& file, diag::Sink& sink) {
        if (call.check_only)
            compile(file, call.check, call, sink);
        else
            emit(file, call, sink);
    });
}

/// Says what this etlc lacks; returns whether that is nothing.
bool has_all(const std::string& missing) {
    if (!missing.empty()) print_error(fmt::format("etlc: {}\n", missing));
    return missing.empty();
}

bool can_make_pages() {
    return has_all(report::what_is_missing());
}

bool can_serve_pages() {
    return has_all(label::what_serving_lacks()) && can_make_pages();
}

int run_trace(Call& call) {
    const bool has_other_output =
        call.run.summary || call.run.changes || !call.run.html.empty() || !call.run.svg.empty();
    if (has_other_output && !call.has("--output")) call.output.clear();
    if (!call.run.html.empty() && !can_make_pages()) return kFailed;
    return on_plan<run>(call);
}

int make_report(Call& call) {
    return can_make_pages() ? on_plan<report>(call) : kFailed;
}

int make_labels(Call& call) {
    return call.label.proposals || can_serve_pages() ? on_spec<label>(call) : kFailed;
}

/// Steps before and after an alarm, and incidents that may be open at a time.
const plan::RecorderRequest kUsualRecorder = {{150, false, "150"}, {60, false, "60"}, 4};

int watch_source(Call& call) {
    if (call.watch.has_page && !can_serve_pages()) return kFailed;
    if (!call.watch.record.empty() && !call.recorder) call.recorder = kUsualRecorder;
    return on_plan<watch>(call);
}

int annotate_set(Call& call) {
    const bool has_output = !call.output.empty() || call.annotate.in_place;
    if (!call.annotate.wanted.any() && (has_output || call.annotate.list.empty()))
        return complain("etlc annotate", "expected --success, --subtasks or --progress, or --list");
    if (call.annotate.wanted.any() && !has_output)
        return complain("etlc annotate", "expected -o FOLDER or --in-place");
    return on_plan<annotate>(call);
}

int evaluate_specs(Call& call) {
    return with_specs(call, [&](const auto& files, auto& sinks) {
        std::vector<SpecToJudge> specs;
        for (std::size_t i = 0; i < files.size(); ++i) specs.push_back({files[i], sinks[i]});
        evaluate(specs, call);
    });
}

int serve_editors(Call&) {
    return lsp::serve(STDIN_FILENO, STDOUT_FILENO);
}

int merge(Call& call);

/// The function of each command, in the order of Command.
constexpr int (*kFunctions[])(Call& call) = {
    compile_spec,      run_trace,      on_spec<embed>, on_spec<fit>, on_spec<calibrate>,
    evaluate_specs,    evaluate_specs, serve_editors,  merge,        on_plan<explain>,
    on_plan<incident>, make_report,    make_labels,    watch_source, on_plan<prove>,
    on_plan<dossier>,  annotate_set};
static_assert(std::size(kFunctions) == kCommandCount);

int execute(Command command, int argc, char** argv, episodes::Sharing* merged = nullptr) {
    Call call(command);
    call.merged = merged;
    if (const auto status = parse(argc, argv, call)) return *status;
    if (call.explains) call.values = check::Values::sourced;
    return kFunctions[static_cast<std::size_t>(command)](call);
}

/// Runs the call that wrote the parts, with their episodes.
int merge(Call& call) {
    diag::Sink sink;
    auto sharing = read_parts(call.parts, sink);
    if (!sharing) return conclude(call.diagnostics, source::File(), sink);
    std::vector<std::string> words = merged_call(sharing->part(), call.output);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    const Command command = words[0] == "evaluate" ? Command::evaluate : Command::calibrate;
    return execute(command, static_cast<int>(arguments.size()), arguments.data(), &*sharing);
}

int execute(int argc, char** argv) {
    if (const std::string mistake = mistake_in_words(argc, argv); !mistake.empty())
        return complain("etlc", mistake);
    const std::string_view word = argc > 1 ? argv[1] : "";
    if (const auto command = command_named(word)) return execute(*command, argc - 1, argv + 1);
    // With a spec, --explain is an option of the generated class.
    if (word == "--explain" && argc == 3 && is_code(argv[2])) return explain_code_command(argv[2]);
    if (word == "--completion" && argc == 3) return completion_command(argv[2]);
    if (word == "--man" && argc == 2) return manual_command();
    if (const std::string mistake = mistake_in_command(argc, argv); !mistake.empty())
        return complain("etlc", mistake);
    return execute(Command::compile, argc, argv);
}

}  // namespace

}  // namespace etlc::driver

int main(int argc, char** argv) {
    using namespace etlc::driver;
    prepare_process();
    try {
        return go_on_in_ranks(argv) ? execute(argc, argv) : kFailed;
    } catch (...) {
        return say_what_failed();
    }
}
