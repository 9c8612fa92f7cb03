// A call of etlc: the command and its options, parsed from the words of the command line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "driver/commands/request.hpp"

namespace etlc::driver {

/// The commands in the order of `etlc --help`; `compile` is etlc without a command.
enum class Command : std::uint8_t {
    compile,
    run,
    embed,
    fit,
    calibrate,
    evaluate,
    crossvalidate,
    lsp,
    merge,
    explain,
    incident,
    report,
    label,
    watch,
    prove,
    dossier,
    annotate,
};
inline constexpr std::size_t kCommandCount = 17;

/// The default of etlc crossvalidate.
inline constexpr std::uint32_t kUsualFolds = 5;

struct Call : Request {
    explicit Call(Command of) : command(of) {
        if (of == Command::crossvalidate) folds = kUsualFolds;
        if (of == Command::run || of == Command::explain || of == Command::incident ||
            of == Command::prove)
            output = "-";
    }

    Command command;
    std::set<std::string, std::less<>> given;  ///< names of the options in the call: "--output"

    std::vector<std::string> specs;
    std::vector<std::string> parts;  ///< of merge
    std::string diagnostics = "text";
    std::vector<std::string> warnings;
    bool check_only = false;
    bool on_standard_streams = false;  ///< of lsp

    bool has(std::string_view option) const { return given.contains(option); }
};

struct CommandText {
    std::string name;     ///< "etlc", "etlc run"
    std::string summary;  ///< may have several lines
    std::string footer;
};

/// Returns how --help presents the command.
CommandText text_of(Command command);

/// Returns "run", ...
std::vector<std::string> command_names();
/// Finds a command by its name.
std::optional<Command> command_named(std::string_view word);

/// Says what is wrong with the call of "etlc run"; the exit status.
int complain(const std::string& command, const std::string& mistake);

/// Fills in the call. An exit status where the command ends here: --help, --version, a wrong call.
std::optional<int> parse(int argc, char** argv, Call& call);

}  // namespace etlc::driver
