// The command line. Exit status: 0; 1 the spec or its data is wrong; 2 the call is wrong.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <list>

#include "data/file.hpp"
#include "diag/render.hpp"
#include "driver/calibrate.hpp"
#include "driver/compile.hpp"
#include "driver/evaluate.hpp"
#include "driver/names.hpp"
#include "driver/run.hpp"
#include "driver/version.hpp"
#include "parse/parse.hpp"
#include "plan/stored.hpp"

namespace {

using namespace etlc;

constexpr int kOk = 0;
constexpr int kWrongSpec = 1;
constexpr int kWrongCall = 2;

struct Call {
    std::string spec;
    std::string output;
    std::string depfile;
    std::string targets_file;    ///< where large target sets go; empty: nowhere
    bool targets_named = false;  ///< by the call, which then expects the file even where nothing goes to it
    std::string diagnostics = "text";
    std::vector<std::string> warnings;
    bool check_only = false;
    driver::Request request;
    driver::RunRequest run;
    driver::CalibrateRequest calibrate;
    driver::EvaluateRequest evaluate;
};

bool warnings_are_errors(const Call& call) {
    return std::find(call.warnings.begin(), call.warnings.end(), "error") != call.warnings.end();
}

/// Prints the findings; the exit status that they mean.
int conclude(const Call& call, const source::File& file, const diag::Sink& sink) {
    diag::RenderOptions options;
    options.warnings_as_errors = warnings_are_errors(call);
    options.colour = isatty(STDERR_FILENO) != 0;
    const bool json = call.diagnostics == "json";
    const std::string text = json ? diag::render_json(file, sink, options) : diag::render_text(file, sink, options);
    fmt::print(stderr, "{}", text);
    return sink.has_errors() || (options.warnings_as_errors && sink.warnings() > 0) ? kWrongSpec : kOk;
}

/// "monitor.hpp: spec.etl targets/a.npy", as make and ninja read it.
std::string dependency_rule(const std::string& output, const std::string& spec, const std::vector<std::string>& files) {
    const auto escaped = [](const std::string& path) {
        std::string text;
        for (char c : path) {
            if (c == ' ' || c == '#') text += '\\';
            if (c == '$') text += '$';
            text += c;
        }
        return text;
    };
    std::string rule = escaped(output) + ": " + escaped(spec);
    for (const std::string& file : files) rule += " \\\n  " + escaped(file);
    return rule + "\n";
}

/// A file of the output that takes its name only when all others are complete too.
class OutputFile {
public:
    OutputFile(std::string path, diag::Sink& sink) : path_(std::move(path)), sink_(sink) {
        auto file = data::AtomicFile::create(path_ == "-" ? "/dev/stdout" : path_, diag::Code::unwritable_output);
        if (file)
            file_.emplace(std::move(*file));
        else
            report(file.failure());
    }
    /// False, and reported, where it cannot be written.
    bool write(std::string_view bytes) { return file_ && succeeds(file_->write(bytes)); }
    bool commit() { return file_ && succeeds(file_->commit()); }

private:
    bool succeeds(const std::optional<diag::Failure>& failure) {
        if (failure) report(*failure);
        return !failure;
    }
    void report(const diag::Failure& failure) { sink_.report(data::in_file(failure, path_)); }

    std::string path_;
    diag::Sink& sink_;
    std::optional<data::AtomicFile> file_;
};

/// The header, the file of targets where there is one, and the dependencies: all of them or none. The header is the
/// last to appear, so that whoever sees it finds its targets.
void write_output(const Call& call, const driver::Output& output, diag::Sink& sink) {
    std::list<OutputFile> files;
    const auto add = [&](const std::string& path) -> OutputFile& { return files.emplace_back(path, sink); };
    bool written = true;
    if (call.request.emit == "hpp" && (call.targets_named || !output.compiled.plan.stored.empty())) {
        OutputFile& targets = add(call.targets_file);
        written = plan::store(output.compiled.plan, [&](const std::uint8_t* bytes, std::size_t size) {
            return targets.write({reinterpret_cast<const char*>(bytes), size});
        });
    }
    if (!call.depfile.empty())
        written = written && add(call.depfile).write(dependency_rule(call.output, call.spec, output.dependencies));
    written = written && add(call.output).write(output.text);
    for (OutputFile& file : files) written = written && file.commit();
}

bool read_spec(const std::string& path, source::File& file, diag::Sink& sink) {
    // Far more than parse/ takes, which refuses a large spec with its size and what to do about it.
    constexpr std::size_t kMostRead = 64 * parse::kMaxSpecBytes;
    auto text = data::read_file(path, kMostRead, diag::Code::unreadable_spec);
    file = source::File(path, text ? std::move(*text) : "");
    if (!text) sink.report(data::in_file(text.failure(), path));
    return static_cast<bool>(text);
}

int compile_spec(const Call& call) {
    diag::Sink sink;
    source::File file;
    if (!read_spec(call.spec, file, sink)) return conclude(call, file, sink);
    const auto output = driver::emit(file, call.request, sink);
    const bool refused = !output || (warnings_are_errors(call) && sink.warnings() > 0);
    if (!refused && !call.check_only) write_output(call, *output, sink);
    return conclude(call, file, sink);
}

int run_trace(const Call& call) {
    diag::Sink sink;
    source::File file;
    if (!read_spec(call.spec, file, sink)) return conclude(call, file, sink);
    const auto compiled = driver::compile(file, call.request, sink);
    const bool refused = !compiled || (warnings_are_errors(call) && sink.warnings() > 0);
    if (!refused) {
        driver::RunRequest request = call.run;
        request.progress = isatty(STDERR_FILENO) != 0;
        driver::run(*compiled, request, sink);
    }
    return conclude(call, file, sink);
}

int calibrate_spec(const Call& call) {
    diag::Sink sink;
    source::File file;
    if (!read_spec(call.spec, file, sink)) return conclude(call, file, sink);
    driver::CalibrateRequest request = call.calibrate;
    request.warnings_are_errors = warnings_are_errors(call);
    request.progress = isatty(STDERR_FILENO) != 0;
    driver::calibrate(file, request, sink);
    return conclude(call, file, sink);
}

void add_spec_options(CLI::App& app, Call& call) {
    app.add_option("spec", call.spec, "the spec, a .etl file")->type_name("SPEC.etl")->required();
    app.add_option("-W", call.warnings, "-Werror: warnings are errors")
        ->type_name("error")
        ->check(CLI::IsMember({"error"}));
    app.add_option("--diagnostics", call.diagnostics, "how to print them")
        ->check(CLI::IsMember({"text", "json"}))
        ->capture_default_str();
}

void add_common_options(CLI::App& app, Call& call) {
    add_spec_options(app, call);
    app.add_option("--thresholds", call.request.check.thresholds_path,
                   "calibrated thresholds (default: SPEC.thresholds.json beside the spec, where it exists)")
        ->type_name("FILE");
    app.add_option("--values", call.request.values,
                   "what monitors compute with; boolean: truth values, and only what can still change a verdict")
        ->transform(
            CLI::CheckedTransformer(std::map<std::string, check::Values>{{"robustness", check::Values::robustness},
                                                                         {"boolean", check::Values::boolean}})
                .description("robustness|boolean"))
        ->default_str("robustness");
    app.add_option("--max-state", call.request.limits.state_bytes, "most bytes of state")->capture_default_str();
    app.add_option("--max-code", call.request.limits.code_bytes, "most bytes of code, estimated, targets aside")
        ->capture_default_str();
    app.add_option("--max-work", call.request.limits.operations, "most operations of the temporal part a step")
        ->capture_default_str();
}

/// a or a::b
bool names_namespace(std::string_view name) {
    bool starts = true;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto c = static_cast<unsigned char>(name[i]);
        const bool separator = starts ? false : name.substr(i, 2) == "::";
        if (separator)
            ++i;
        else if (starts ? std::isalpha(c) == 0 : std::isalnum(c) == 0 && c != '_')
            return false;
        starts = separator;
    }
    return !starts;
}

std::string emit_help() {
    std::string text = "print a stage instead of the header:";
    for (const auto& [name, summary] : driver::emittable()) text += fmt::format("\n{:>30} {}", name + ":", summary);
    return text;
}

void add_compile_options(CLI::App& app, Call& call) {
    std::vector<std::string> stages;
    for (const auto& [name, summary] : driver::emittable()) stages.push_back(name);
    app.add_option("-o,--output", call.output, "where to write the result; - is standard output")->type_name("FILE");
    app.add_flag("--check", call.check_only, "diagnostics only");
    app.add_option("--emit", call.request.emit, emit_help())->check(CLI::IsMember(stages))->type_name("STAGE");
    app.add_flag("--standalone", call.request.standalone, "paste the runtime in: one file to copy into firmware");
    app.add_option("--namespace", call.request.name_space, "of the generated code (default: the spec's name)")
        ->type_name("NAME")
        ->check(CLI::Validator(
            [](const std::string& name) {
                return names_namespace(name) ? std::string() : fmt::format("'{}' is not the name of a namespace", name);
            },
            ""));
    app.add_option("--inline-targets", call.request.limits.inline_target_bytes,
                   "target sets of more bytes are not spelled out in the header, but go to a file beside it")
        ->type_name("BYTES")
        ->capture_default_str();
    app.add_option("--targets-file", call.targets_file,
                   "that file (default: STEM.targets.bin beside STEM.hpp, where something goes to it); named, it is "
                   "always written, perhaps empty")
        ->type_name("FILE");
    app.add_option("--depfile", call.depfile, "also write what the output depends on, for make and ninja")
        ->type_name("FILE");
}

/// The call's own mistakes that CLI11 cannot see; empty where there are none.
std::string mistake_in(const Call& call, const CLI::App& app) {
    const bool prints_stage = app.count("--emit") > 0;
    if (call.check_only && (prints_stage || !call.output.empty()))
        return "--check goes neither with --emit nor with -o";
    if (!call.check_only && !prints_stage && call.output.empty())
        return "say where to write the header with -o, or --check";
    if (!call.depfile.empty() && (call.output.empty() || call.output == "-")) return "--depfile needs -o FILE";
    if (app.count("--targets-file") > 0 && (call.targets_file.empty() || call.targets_file == "-" ||
                                            call.targets_file == call.output || call.targets_file == call.depfile))
        return "--targets-file needs a file of its own";
    if (app.count("--targets-file") > 0 && prints_stage && call.request.emit != "hpp")
        return "--targets-file goes with the header, not with other stages";
    return "";
}

int complain(const CLI::App& app, const std::string& mistake) {
    fmt::print(stderr, "etlc: {}\nRun {} --help for more information.\n", mistake, app.get_name());
    return kWrongCall;
}

int parse_arguments(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& wish) {  // --help, --version
        app.exit(wish);
        return kOk;
    } catch (const CLI::ParseError& error) {
        return complain(app, error.what());
    }
    return -1;
}

/// monitor.targets.bin for monitor.hpp, in the same folder; none for standard output. A check writes nothing, so any
/// name does.
void name_targets_file(Call& call) {
    call.targets_named = !call.targets_file.empty();
    const std::filesystem::path header = call.check_only ? call.spec : call.output;
    if (!call.targets_named && header != "-")
        call.targets_file = (header.parent_path() / (header.stem().string() + ".targets.bin")).string();
    call.request.targets_file = std::filesystem::path(call.targets_file).filename().string();
}

int compile_command(int argc, char** argv) {
    Call call;
    CLI::App app(
        "etlc, the compiler for Embedding Temporal Logic: SPEC.etl in, one C++ monitor class out.\n"
        "Other commands: etlc run SPEC.etl --trace FILE, etlc calibrate SPEC.etl --data FILE...,\n"
        "etlc evaluate SPEC.etl --data FILE...",
        "etlc");
    app.set_version_flag("--version", fmt::format("etlc {}", driver::kVersion));
    add_common_options(app, call);
    add_compile_options(app, call);
    if (const int status = parse_arguments(app, argc, argv); status >= 0) return status;
    if (const std::string mistake = mistake_in(call, app); !mistake.empty()) return complain(app, mistake);
    if (call.output.empty()) call.output = "-";
    name_targets_file(call);
    return compile_spec(call);
}

int run_command(int argc, char** argv) {
    Call call;
    CLI::App app("Executes a spec's monitors on a recorded trace, without a C++ compiler, in constant memory.",
                 "etlc run");
    add_common_options(app, call);
    app.add_option("--trace", call.run.trace,
                   "the trace: .csv, .npz or .h5; FILE.h5:GROUP is the episode in a group of it")
        ->type_name("FILE")
        ->required();
    std::vector<std::string> names;
    app.add_option("--map", names, "what an input is called in the trace: --map z=obs/z")->type_name("NAME=OTHER");
    app.add_option("-o,--output", call.run.output, "where to write the verdicts, as CSV; - is standard output")
        ->type_name("FILE")
        ->capture_default_str();
    app.add_flag("--finish", call.run.finish, "after the trace, also report the last positions of sliding monitors");
    if (const int status = parse_arguments(app, argc, argv); status >= 0) return status;
    std::string mistake;
    const auto parsed = driver::parse_names(names, mistake);
    if (!parsed) return complain(app, mistake);
    call.run.names = *parsed;
    return run_trace(call);
}

int calibrate_command(int argc, char** argv) {
    Call call;
    CLI::App app("Finds the calibrated thresholds of a spec from labelled demonstrations, one episode a file.",
                 "etlc calibrate");
    add_spec_options(app, call);
    std::vector<std::string> names;
    app.add_option("--data", call.calibrate.calibration.data,
                   "demonstrations: .npz, .csv and .h5 files, folders, patterns")
        ->type_name("FILE...")
        ->required();
    app.add_option("--episodes", call.calibrate.calibration.groups, "groups of .h5 files that are episodes: 'data/*'")
        ->type_name("PATTERN");
    app.add_option("--map", names, "what an input is called in the files: --map z=obs/z")->type_name("NAME=OTHER");
    app.add_option(
           "-o,--output", call.calibrate.output,
           "where to write the thresholds (default: SPEC.thresholds.json beside the spec); - is standard output")
        ->type_name("FILE");
    app.add_option(
           "--thresholds", call.calibrate.thresholds,
           "the thresholds of the predicates: then the monitors that are calibrated as a whole are, on episodes "
           "that these thresholds have not seen")
        ->type_name("FILE");
    app.add_option("-j,--jobs", call.calibrate.calibration.jobs, "threads (default: as many as the machine has)")
        ->type_name("N")
        ->check(CLI::Range(1U, 1024U));
    if (const int status = parse_arguments(app, argc, argv); status >= 0) return status;
    std::string mistake;
    const auto parsed = driver::parse_names(names, mistake);
    if (!parsed) return complain(app, mistake);
    call.calibrate.calibration.names = *parsed;
    return calibrate_spec(call);
}

int evaluate_spec(const Call& call) {
    diag::Sink sink;
    source::File file;
    if (!read_spec(call.spec, file, sink)) return conclude(call, file, sink);
    driver::EvaluateRequest request = call.evaluate;
    request.warnings_are_errors = warnings_are_errors(call);
    request.progress = isatty(STDERR_FILENO) != 0;
    driver::evaluate(file, call.request, request, sink);
    return conclude(call, file, sink);
}

int evaluate_command(int argc, char** argv) {
    Call call;
    CLI::App app("Compares a spec's predicates and monitors with ground truth on recorded episodes.", "etlc evaluate");
    add_common_options(app, call);
    app.add_option("--data", call.evaluate.data, "episodes: files (.npz, .csv, .h5), folders and 'patterns'")
        ->type_name("FILE")
        ->required();
    std::vector<std::string> names;
    app.add_option("--map", names, "what an input is called in the episodes: --map z=obs/z")->type_name("NAME=OTHER");
    app.add_option("--episodes", call.evaluate.groups, "of .h5 files, the groups that are episodes: 'data/*'")
        ->type_name("PATTERN");
    app.add_option("--json", call.evaluate.json, "also write the result as JSON; - is standard output")
        ->type_name("FILE");
    app.add_option("--csv", call.evaluate.csv, "also write the result as CSV; - is standard output")->type_name("FILE");
    app.add_option("-j,--jobs", call.evaluate.evaluation.jobs, "threads (default: as many as the machine has)")
        ->type_name("N")
        ->check(CLI::Range(1U, 1024U));
    if (const int status = parse_arguments(app, argc, argv); status >= 0) return status;
    std::string mistake;
    const auto parsed = driver::parse_names(names, mistake);
    if (!parsed) return complain(app, mistake);
    call.evaluate.evaluation.names = *parsed;
    return evaluate_spec(call);
}

}  // namespace

int main(int argc, char** argv) {
    const std::string_view command = argc > 1 ? argv[1] : "";
    if (command == "run") return run_command(argc - 1, argv + 1);
    if (command == "evaluate") return evaluate_command(argc - 1, argv + 1);
    if (command == "calibrate") return calibrate_command(argc - 1, argv + 1);
    return compile_command(argc, argv);
}
