// The request of a call of etlc: the options that several commands share, and those of each
// command. Keeps true: a member that no option sets has its default.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "annotate/judge.hpp"
#include "check/check.hpp"
#include "compile.hpp"
#include "embed/encoder.hpp"
#include "episodes/labels/labels.hpp"
#include "episodes/shared/sharing.hpp"
#include "episodes/variants/variants.hpp"
#include "recordings/open.hpp"
#include "report/report.hpp"

namespace etlc::driver {

enum class ExplanationFormat : std::uint8_t { text, json };
enum class IncidentFormat : std::uint8_t { table, csv, trace, spec };

/// Which part of the episodes a call reads: `--shard I/N`.
struct ShardRequest {
    std::uint32_t shard = 0;   ///< 1 to `shards`
    std::uint32_t shards = 0;  ///< 0: all episodes
    std::string part;          ///< the file that this shard writes
    /// Standard input lists the shards, a number a line. Each goes to NUMBER.part in the folder
    /// `part`, and its number to standard output. `shard` is 0.
    bool from_input = false;
};

struct Request : CompileOptions {
    /// Settings of constants, and the files of thresholds, fitted entries and embeddings; an empty
    /// path stands for the file beside the spec.
    check::Options check = {.open_trace = recordings::open_trace};
    std::string output;  ///< -o; "-" is standard output, empty the usual place of the command

    std::vector<std::string> data;  ///< episodes or recordings: files, folders and patterns
    recordings::Chosen chosen;      ///< which of the episodes in `data`
    std::string trace;
    recordings::NamesInFile names;  ///< names of inputs and labels in the files
    episodes::LabelSources labels;  ///< besides those in the files
    std::string allow_overlap;      ///< why overlaps are accepted; empty: they are refused
    unsigned jobs = 0;              ///< threads; 0: as many as the machine has
    std::uint32_t folds = 0;        ///< 0: none
    bool in_order = false;          ///< folds are judged by those before them
    ShardRequest shard;
    std::vector<std::string> words;       ///< the call itself, from the command on
    episodes::Sharing* merged = nullptr;  ///< the parts of all shards; null: episodes are read

    // The compiler.
    bool explains = false;     ///< the class has why_NAME()
    std::string emit = "hpp";  ///< ast, graph, plan, or a backend of emit/header.cpp
    std::string name_space;
    std::string standalone;      ///< emit::Options::standalone
    std::string depfile;         ///< empty: none
    std::string targets;         ///< where large target sets go; empty: nowhere
    std::string params;          ///< where the parameters of a retargetable class go
    bool targets_named = false;  ///< the call names `targets`, which is written even when empty

    struct Run {
        bool summary = false;    ///< a line for each monitor, on standard output
        bool distances = false;  ///< a column for the distance or expression of each predicate
        bool changes = false;    ///< a line for each change, on standard output
        bool finish = false;     ///< also the positions reported after the end of the trace
        std::string html;        ///< page of the trace; empty: none
        std::string svg;         ///< picture of its timelines; empty: none
    } run;

    struct Watch {
        std::string video;  ///< path or address; empty: the trace
        bool has_page = false;
        std::uint32_t port = 0;  ///< of the page; 0: any free one
        std::string record;      ///< folder of incidents; empty: none
    } watch;

    struct Embed {
        embed::Running running;
        /// Cameras of data sets and arrays by input; "" stands for all inputs.
        std::map<std::string, std::string> cameras;
        std::string references;  ///< folder for the reference frames; empty: they are not written
        std::string pipe;        ///< encoder of the frames on standard input; empty: none
    } embed;

    struct Fit {
        bool suggest = false;                 ///< print candidates for `predicates`, write no file
        std::vector<std::string> predicates;  ///< empty: all that have labels
        bool json = false;
    } fit;

    struct Evaluate {
        std::string json;  ///< file; empty: none
        std::string csv;
        bool by_episode = false;  ///< also a row for each episode, the only rows of the CSV
        std::vector<episodes::Variant> variants;  ///< failures to make of the episodes
    } evaluate;

    struct Explain {
        std::string monitor;                ///< empty: the first alarm, else the first monitor
        std::optional<std::uint64_t> step;  ///< nothing: the usual step
        std::optional<double> at;           ///< the step by its time in seconds
        ExplanationFormat format = ExplanationFormat::text;
    } explain;

    struct Incident {
        std::string file;
        IncidentFormat format = IncidentFormat::table;
    } incident;

    struct Prove {
        std::uint32_t steps = 0;     ///< 0: as many as usual
        std::string header;          ///< file; empty: the class is generated
        std::string counterexample;  ///< stem of two files; empty: the usual one
    } prove;

    struct Annotate {
        annotate::Wanted wanted;
        bool in_place = false;
        std::string made;  ///< folder of the episodes that `etlc embed` made; empty: none
        std::string list;  ///< file; empty: none
    } annotate;

    struct Report {
        report::FramesOption frames;
        std::uint64_t megabytes = report::kUsualMegabytes;  ///< size of the page
        bool without_truths = false;                        ///< compare verdicts with nothing
    } report;

    struct Label {
        std::uint32_t port = 0;  ///< 0: any free one
        bool proposals = false;  ///< print proposals in place of serving the page
    } label;
};

}  // namespace etlc::driver
