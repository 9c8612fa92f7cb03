// A call of etlc: the command, and all that its options say.
// Takes: the words of the command line, by the table of options. Gives: the requests of the
// commands. Keeps true: what no option sets has its default.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "driver/compile/compile.hpp"
#include "driver/compile/output.hpp"
#include "driver/embed/embed.hpp"
#include "driver/evaluate/evaluate.hpp"
#include "driver/explain/explain.hpp"
#include "driver/incident/incident.hpp"
#include "driver/learn/calibrate.hpp"
#include "driver/learn/fit.hpp"
#include "driver/report/report.hpp"
#include "driver/run/run.hpp"

namespace etlc::driver {

/// In the order of `etlc --help`; `compile` is etlc without a command.
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
};
inline constexpr std::size_t kCommandCount = 12;

/// Of etlc crossvalidate.
inline constexpr std::uint32_t kUsualFolds = 5;

struct Call {
    explicit Call(Command of) : command(of) {
        if (of == Command::crossvalidate) evaluate.folds = kUsualFolds;
    }

    Command command;
    std::vector<std::string> words;            ///< all of them, from the command on
    std::set<std::string, std::less<>> given;  ///< names of the options in the call: "--output"

    std::vector<std::string> specs;
    std::vector<std::string> parts;  ///< of merge
    std::string diagnostics = "text";
    std::vector<std::string> warnings;
    bool check_only = false;
    bool on_standard_streams = false;  ///< of lsp
    OutputPaths output;
    Request request;
    RunRequest run;
    EmbedRequest embed;
    FitRequest fit;
    CalibrateRequest calibrate;
    EvaluateRequest evaluate;
    ExplainRequest explain;
    IncidentRequest incident;
    ReportRequest report;

    bool has(std::string_view option) const { return given.contains(option); }

    // Where the options that several commands share go in the command's request.
    std::vector<std::string>& data();
    std::string& groups();
    std::string& allow_overlap();
    unsigned& jobs();
    data::NamesInFile& names();
    std::string& trace();
    std::vector<check::Setting>& settings();
    std::string& thresholds();
    std::string& fitted();
    std::string& embedded();
    std::uint32_t& folds();
    ShardRequest& shard();
    std::string& written();  ///< -o
};

}  // namespace etlc::driver
