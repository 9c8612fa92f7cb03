#include "driver/options/call.hpp"

#include <fmt/format.h>

#include <iterator>

namespace etlc::driver {

namespace {

struct Row {
    Command command;
    std::string_view name;   ///< empty: etlc without a command
    std::string_view takes;  ///< the least arguments; may be empty
    std::string_view summary;
};
constexpr Row kCommands[] = {
    {Command::compile, "", "", ""},
    {Command::run, "run", "SPEC.etl --trace FILE",
     "Executes a spec's monitors on a recorded trace, without a C++ compiler, in constant memory."},
    {Command::embed, "embed", "SPEC.etl --data FILE... -o FOLDER",
     "Encodes the images and videos that a spec names into SPEC.embedded.npz beside it, and "
     "recordings into\nepisodes for the other commands."},
    {Command::fit, "fit", "SPEC.etl --data FILE...",
     "Finds the projections, targets and metrics that a spec declares fitted(...) from labelled "
     "demonstrations,\none episode a file, and reports how well its predicates then separate."},
    {Command::calibrate, "calibrate", "SPEC.etl --data FILE...",
     "Finds the calibrated thresholds of a spec from labelled demonstrations, one episode a file."},
    {Command::evaluate, "evaluate", "SPEC.etl... --data FILE...",
     "Compares predicates and monitors of specs with ground truth on recorded episodes."},
    {Command::crossvalidate, "crossvalidate", "SPEC.etl... --data FILE...",
     "Calibrates and evaluates specs on the same recorded episodes, in folds: each episode is "
     "judged\nby monitors that have not seen it."},
    {Command::lsp, "lsp", "",
     "The language server, for editors: it speaks the Language Server Protocol on standard input "
     "and output.\ndocs/editors.md says how editors start it."},
    {Command::merge, "merge", "PART...",
     "Combines the parts that all shards of a call wrote into the result of the call."},
    {Command::explain, "explain", "SPEC.etl --trace FILE",
     "Explains a monitor's verdict on a recorded trace: a minimal set of samples that decides "
     "it, the\nsample whose robustness it has, and the smallest change that would flip it."},
    {Command::incident, "incident", "FILE --spec SPEC.etl",
     "Prints what the flight recorder of a monitor wrote: the steps around an alarm."},
    {Command::report, "report", "SPEC.etl --data FILE... -o PAGE.html",
     "Writes a web page about recorded episodes: the verdicts of a spec's monitors, why, and where "
     "they are wrong."},
    {Command::label, "label", "SPEC.etl --data FILE...",
     "Serves a page, on this machine alone, on which you label the predicates of a spec in "
     "recorded "
     "episodes."},
    {Command::watch, "watch", "SPEC.etl --video SOURCE",
     "Steps a spec's monitors with a camera, a stream, a video or a trace as it comes, and prints "
     "a line where\nsomething changes, until the source ends or you press Ctrl-C."},
    {Command::prove, "prove", "SPEC.etl",
     "Proves that the temporal part of a generated class gives the verdicts of the definition, for "
     "all\ninputs of a number of steps, or shows an input on which it does not. It needs a C++ "
     "compiler, $CXX or c++."},
    {Command::dossier, "dossier", "SPEC.etl -o FOLDER",
     "Collects what an engineer needs who signs for a generated class: the class, the certificate "
     "of etlc prove\nand what it has executed, the budget, what the thresholds are worth, coding "
     "rules, limitations."},
    {Command::annotate, "annotate", "SPEC.etl --data DATASET -o DATASET2",
     "Writes what monitors say of a LeRobot data set into a copy of it: success, subtasks and "
     "progress,\nand a list of its episodes, the worst first."}};
static_assert(std::size(kCommands) == kCommandCount);

}  // namespace

CommandText text_of(Command command) {
    const Row& row = kCommands[static_cast<std::size_t>(command)];
    if (!row.name.empty()) return {fmt::format("etlc {}", row.name), std::string(row.summary), ""};
    std::string summary =
        "etlc, the compiler for Embedding Temporal Logic: SPEC.etl in, one C++ monitor class "
        "out.\nOther commands:\n";
    for (const Row& other : kCommands)
        if (!other.name.empty())
            summary += fmt::format("  etlc {}{}{}\n", other.name, other.takes.empty() ? "" : " ",
                                   other.takes);
    summary += "  etlc --explain CODE\n  etlc --completion bash\n  etlc --man";
    return {"etlc", summary,
            "Exit status: 0, success; 1, failure, which a message explains; 2, the call is wrong; "
            "3, an internal error of etlc."};
}

std::vector<std::string> command_names() {
    std::vector<std::string> names;
    for (const Row& row : kCommands)
        if (!row.name.empty()) names.emplace_back(row.name);
    return names;
}

std::optional<Command> command_named(std::string_view word) {
    for (const Row& row : kCommands)
        if (!row.name.empty() && row.name == word) return row.command;
    return std::nullopt;
}

}  // namespace etlc::driver
