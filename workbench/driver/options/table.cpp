// The table of all options: first those that several commands share, and those of the compiler.

#include "driver/options/table.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "data/text/text.hpp"
#include "driver/commands/commands.hpp"
#include "driver/options/mistakes.hpp"
#include "recordings/open.hpp"

namespace etlc::driver {

namespace {

using enum Command;

Takes limit(std::uint64_t plan::Limits::*bytes) {
    return number<std::uint64_t>(in(&Call::limits, bytes), 0,
                                 std::numeric_limits<std::uint64_t>::max(),
                                 std::to_string(plan::Limits().*bytes));
}

std::string emit_help() {
    std::string text = "print a stage instead of the header:";
    for (const auto& [name, summary] : emittable())
        text += fmt::format("\n{:>30} {}", name + ":", summary);
    return text;
}

Takes stages() {
    std::vector<std::string> names;
    for (const auto& [name, summary] : emittable()) names.push_back(name);
    return one_of(std::move(names), in(&Call::emit));
}

Takes warnings() {
    Takes takes = texts("error", in(&Call::warnings));
    takes.choices = {"error"};
    takes.check = [](const std::string& found) { return mistake_in_word(found, {"error"}); };
    return takes;
}

Takes standalone() {
    Takes takes = one_of({"portable", "host"}, in(&Call::standalone));
    takes.usual.clear();
    takes.is_flag = true;
    return takes;
}

Takes settings() {
    Takes takes = several(form("NAME=VALUE", read_settings));
    takes.once_a_name = true;
    return takes;
}

Takes label_by() {
    using episodes::LabelBy;
    Takes takes = choice<LabelBy>(
        {{"folder", LabelBy::folder}, {"outcome", LabelBy::outcome}, {"subtask", LabelBy::subtask}},
        in(&Call::labels, &episodes::LabelSources::by));
    takes.usual.clear();
    return takes;
}

std::vector<Option> shared_options() {
    return {
        {kReadSpec | merge | lsp, "-h,--help", Takes(), "Print this help message and exit"},
        {compile, "--version", Takes(), "Display program version information and exit"},

        // Specs and files.
        {incident, "file", file(in(&Call::incident, &Call::Incident::file)),
         "file written by write_incident()", kRequired},
        {merge, "parts", texts("PART...", in(&Call::parts)), "the parts, in any order", kRequired},
        {kExecute | kLearn | kClass | embed | report | label | watch | annotate, "spec",
         only("SPEC.etl", in(&Call::specs)), "the spec, a .etl file", kRequired},
        {incident, "--spec", only("SPEC.etl", in(&Call::specs)), "the spec, a .etl file",
         kRequired},
        {kEvaluate, "spec", texts("SPEC.etl", in(&Call::specs)),
         "the specs, .etl files; several are compared side by side", kRequired},

        // Diagnostics.
        {kReadSpec, "-W", warnings(), "-Werror: warnings are errors"},
        {kReadSpec, "--diagnostics", one_of({"text", "json"}, in(&Call::diagnostics), "text"),
         "format of the diagnostics"},

        // Settings of the spec.
        {kReadSpec, "--set", settings(),
         "override a constant: --set limit=0.25, --set deadline=2s"},
        {kPlan, "--thresholds", file(in(&Call::check, &check::Options::thresholds_path)),
         "calibrated thresholds (default: SPEC.thresholds.json beside the spec, if it exists)"},
        {kPlan | calibrate, "--fitted", file(in(&Call::check, &check::Options::fitted_path)),
         "file written by 'etlc fit' (default: SPEC.fitted.npz beside the spec, if it exists)"},
        {kPlan | kLearn | label, "--embedded",
         file(in(&Call::check, &check::Options::embedded_path)),
         "embeddings written by 'etlc embed' (default: SPEC.embedded.npz beside the spec)"},
        {kPlan, "--values",
         choice<check::Values>(
             {{"robustness", check::Values::robustness}, {"boolean", check::Values::boolean}},
             in(&Call::values)),
         "values that monitors compute; boolean: truth values, measuring only what can still "
         "change a verdict"},
        {kPlan, "--targets-as",
         choice<plan::Storage>(
             {{"f32", plan::Storage::f32}, {"f16", plan::Storage::f16}, {"i8", plan::Storage::i8}},
             in(&Call::targets_as)),
         "storage of target sets; distances that narrow storage leaves ambiguous are measured in "
         "float32 too"},
        {kPlan, "--max-state", limit(&plan::Limits::state_bytes), "limit on the bytes of state"},
        {kPlan, "--max-code", limit(&plan::Limits::code_bytes),
         "limit on the estimated bytes of code, without targets"},
        {kPlan, "--max-work", limit(&plan::Limits::operations),
         "limit on the operations of the temporal part per step"},

        // Output of the compiler.
        {compile, "-o,--output", file(in(&Call::output)),
         "where to write the result; - is standard output"},
        {compile, "--check", flag(in(&Call::check_only)),
         "only print diagnostics; missing files are no errors"},
        {compile, "--emit", stages(), emit_help()},
        {compile, "--standalone{portable}", standalone(),
         "include the runtime: one file in standard C++ to copy into firmware; --standalone=host: "
         "with vector instructions, selected by the CPU where possible"},
        {kClass, "--namespace", checked(text("NAME", in(&Call::name_space)), mistake_in_namespace),
         "namespace of the generated code (default: the spec's name)"},
        {kClass, "--explain", flag(in(&Call::explains)),
         "generate why_NAME(), which names the sample that decides a verdict, with its step, "
         "distance, threshold and nearest target"},
        {kClass, "--retargetable", retargetable(),
         "store targets, thresholds, projections and numbers in STEM.params.bin beside STEM.hpp; "
         "the class can load another such file between steps, made by --emit params"},
        {kClass | watch, "--recorder", form("B,A,N", read_recorder),
         "record the steps around each alarm: BEFORE,AFTER,INCIDENTS, such as 2s,1s,4 or 40,20,4; "
         "etlc incident prints the records"},
        {kClass, "--lets", lets(),
         "also generate let_NAME() and robustness_NAME(), for lets that do not look ahead"},
        {compile, "--inline-targets", limit(&plan::Limits::inline_target_bytes),
         "largest target set in bytes that is written into the header; larger ones go to a file "
         "beside it"},
        {compile, "--targets-file", file(in(&Call::targets)),
         "file for large target sets (default: STEM.targets.bin beside STEM.hpp, if there are "
         "any); if named, it is always written, even if empty"},
        {compile, "--depfile", file(in(&Call::depfile)),
         "also write the dependencies of the output, for make and ninja"},

        // Recordings.
        {kFindEpisodes, "--data", texts("FILE...", in(&Call::data)),
         "episodes: files (" + recordings::trace_endings() + "), folders, data sets, 'patterns'",
         kRequired},
        {embed, "--data", texts("FILE...", in(&Call::data)),
         "recordings to make episodes of: videos, folders of images, data sets, .npz and .h5 files "
         "of images, folders and 'patterns' of these"},
        {run, "--trace", file(in(&Call::trace)),
         "the trace: .csv, .npz or .h5; FILE.h5:GROUP is an episode in a group, FOLDER:3 an "
         "episode of a data set; - is CSV on standard input, stepped row by row"},
        {run, "--data", texts("FILE...", in(&Call::data)),
         "episodes in place of a trace, one after another: files, folders, data sets, 'patterns'; "
         "the rows begin with the column 'trace'",
         Option::Need::none, "--trace"},
        {explain, "--trace", file(in(&Call::trace)),
         "the trace: .csv, .npz or .h5; FILE.h5:GROUP is an episode in a group, FOLDER:3 an "
         "episode of a data set",
         kRequired},
        {embed, "--camera", several(form("[INPUT=]NAME", read_cameras)),
         "the camera of a data set, or the array of images: observation.images.top; for one input "
         "only, z=observation.images.top"},
        {Commands(kFindEpisodes) | run, "--episodes",
         text("PATTERN", in(&Call::chosen, &recordings::Chosen::groups)),
         "groups of .h5 files that are episodes: 'data/*'"},
        {embed, "--episodes", text("PATTERN", in(&Call::chosen, &recordings::Chosen::groups)),
         "groups of .h5 files that are recordings: 'data/*'"},
        {Commands(kFindEpisodes) | run, "--split", form("FROM:TO", read_split),
         "only a part of the episodes, by shares: --split 0:0.25, --split 0.25:0.5 and --split "
         "0.5:1 share none; dealt by their content, or, as in 0.5:1:order, kept in order"},
        {kReadEpisodes, "--allow-overlap",
         checked(text("REASON", in(&Call::allow_overlap)), mistake_in_reason),
         "reason to accept episodes that share most of their content or contain targets; it is "
         "written into the result"},
        {kFindEpisodes, "-j,--jobs", number<unsigned>(in(&Call::jobs), 1, 1024),
         "threads (default: as many as the machine has)"},
        {kReadEpisodes, "--labels",
         texts("FILE...", in(&Call::labels, &episodes::LabelSources::tables)),
         "tables of labels, .csv files (default: labels.csv beside the episodes, if it exists)"},
        {kReadEpisodes, "--label-by", label_by(),
         "folder: a folder with the name of a predicate labels the episodes in it and below it: it "
         "holds in these, and in no other; folders success and failure give their outcome; "
         "outcome: "
         "an episode succeeded where its next.success, or its .h5 group's attribute success, says "
         "so, and failed where that is false; "
         "subtask: a predicate holds in the rows of a LeRobot data set whose subtask has its name"},
        {kReadRecordings, "--map", several(form("NAME=OTHER", read_names)),
         "name of an input in the files: --map z=obs/z"},
    };
}

// The options of single commands, and of few.

constexpr Commands kEncode = Commands(embed) | watch;

Takes suggest() {
    Takes takes = several(form("[PREDICATE...]", read_suggest));
    takes.may_be_empty = true;
    return takes;
}

using annotate::Wanted;

Takes undecided() {
    Takes takes = choice<bool>({{"false", true}}, in(&Call::annotate, &Call::Annotate::wanted,
                                                     &Wanted::undecided_is_false));
    takes.usual.clear();
    return takes;
}

Takes folds() {
    return number<std::uint32_t>(in(&Call::folds), 2, 1000);
}

/// --page [PORT]
Takes page() {
    Takes takes = form("[PORT]", [](Call& call, const Takes::Words& words) {
        call.watch.has_page = true;
        if (!words.front().empty())
            call.watch.port = data::parse_whole<std::uint32_t>(words.front()).value_or(0);
        return std::string();
    });
    takes.may_be_empty = true;
    takes.check = [](const std::string& found) {
        return found.empty() ? std::string() : mistake_in_number(found, 1, 65535);
    };
    return takes;
}

/// A trace that is watched comes on standard input.
Takes checked_trace() {
    return checked(text("-", in(&Call::trace)), [](const std::string& found) {
        return found == recordings::kStandardInput
                   ? std::string()
                   : fmt::format("found {}, expected -, standard input; etlc run reads files",
                                 data::in_quotes(found));
    });
}

std::vector<Option> own_options() {
    return {
        // etlc run
        {run, "-o,--output", file(in(&Call::output), "-"),
         "where to write the verdicts, as CSV; - is standard output"},
        {run, "--finish", flag(in(&Call::run, &Call::Run::finish)),
         "after the trace, also report the last positions of sliding monitors"},
        {run, "--distances", flag(in(&Call::run, &Call::Run::distances)),
         "add a column for each predicate: the distance or expression that it compares"},
        {run, "--lets", lets(),
         "add a column for each let that does not look ahead: its robustness at the step"},
        {run, "--retargetable", retargetable(),
         "compute the bounds of a --retargetable class, which hold for any parameters"},
        {run, "--summary", flag(in(&Call::run, &Call::Run::summary)),
         "print a line for each monitor, and for inputs with missing samples; rows are written "
         "only with -o"},
        {run, "--changes", flag(in(&Call::run, &Call::Run::changes)),
         "print a line where the status of a monitor or the presence of an input changes, as etlc "
         "watch does; rows are written only with -o"},
        {run, "--html", file(in(&Call::run, &Call::Run::html)),
         "also write a page about the trace; rows are written only with -o"},
        {run, "--svg", file(in(&Call::run, &Call::Run::svg)),
         "also write a picture of its timelines; rows are written only with -o"},

        // etlc explain
        {explain, "--monitor", text("NAME", in(&Call::explain, &Call::Explain::monitor)),
         "the monitor (default: the first that raises an alarm, else the first)"},
        {explain, "--step", number<std::uint32_t>(in(&Call::explain, &Call::Explain::step)),
         "explain the verdict after this step (default: the step of the first alarm, else of the "
         "first final verdict, else the last); sliding monitors also have the steps after the "
         "trace that etlc run --finish reports"},
        {explain, "--at", form("SECONDS", read_seconds), "the step nearest to this time in seconds",
         Option::Need::none, "--step"},
        {explain, "--format",
         choice<ExplanationFormat>(
             {{"text", ExplanationFormat::text}, {"json", ExplanationFormat::json}},
             in(&Call::explain, &Call::Explain::format)),
         "for people or for programs"},
        {incident, "--format",
         choice<IncidentFormat>({{"table", IncidentFormat::table},
                                 {"csv", IncidentFormat::csv},
                                 {"trace", IncidentFormat::trace},
                                 {"spec", IncidentFormat::spec}},
                                in(&Call::incident, &Call::Incident::format)),
         "trace: the measurements as a .csv file for etlc run and etlc explain; spec: the spec "
         "that reads this trace, with the measurements as inputs"},
        {Commands(explain) | incident, "-o,--output", file(in(&Call::output), "-"),
         "where to write it; - is standard output"},

        // etlc embed
        {embed, "-o,--output", text("FOLDER", in(&Call::output)),
         "folder for the episodes, .npz files"},
        {embed, "--embedded", file(in(&Call::check, &check::Options::embedded_path)),
         "file for the embeddings of what the spec names (default: SPEC.embedded.npz beside it)"},
        {embed, "--shard", form("I/N", read_shard),
         "make episodes only of this shard of the recordings; the first shard also encodes what "
         "the spec names"},
        {embed, "--write-reference", text("FOLDER", in(&Call::embed, &Call::Embed::references)),
         "folder for the reference frames, .png files, by which a robot checks its encoder"},
        {embed, "--pipe", text("ENCODER", in(&Call::embed, &Call::Embed::pipe)),
         "encode frames of standard input with this encoder, in the format of docs/recordings.md"},
        {kEncode, "--onnxruntime",
         text("PATH", in(&Call::embed, &Call::Embed::running, &embed::Running::onnxruntime)),
         "ONNX Runtime, which runs the models: the library or its folder (default: "
         "ETLC_ONNXRUNTIME, or an installation by pip, npm or the system)"},
        {kEncode, "--encoder-cmd",
         text("COMMAND", in(&Call::embed, &Call::Embed::running, &embed::Running::command)),
         "command that encodes frames on its standard input to embeddings on its standard output "
         "(docs/recordings.md)",
         Option::Need::none, "--onnxruntime"},
        {kEncode, "--encoder-timeout",
         number<int>(in(&Call::embed, &Call::Embed::running, &embed::Running::max_silence_seconds),
                     1, 86400, std::to_string(embed::Running().max_silence_seconds)),
         "seconds after which an encoder that neither reads nor writes is stopped"},

        // etlc fit
        {fit, "-o,--output", file(in(&Call::output)),
         "where to write the fitted entries (default: SPEC.fitted.npz beside the spec); - is "
         "standard output"},
        {fit, "--suggest", suggest(),
         "try distances, targets and projections for these predicates (default: all with labels) "
         "and print\nhow well each separates, with the lines to paste; nothing is written",
         Option::Need::none, "--output"},
        {fit, "--json", flag(in(&Call::fit, &Call::Fit::json)), "with --suggest: print JSON",
         Option::Need::none, "", "--suggest"},

        // etlc annotate
        {annotate, "--data", only("DATASET", in(&Call::data)),
         "the data set, a folder in LeRobot's format", kRequired},
        {annotate, "-o,--output", text("FOLDER", in(&Call::output)),
         "the annotated copy, a new folder; videos become hard links where possible"},
        {annotate, "--in-place", flag(in(&Call::annotate, &Call::Annotate::in_place)),
         "put the annotated copy in the place of the data set", Option::Need::none, "--output"},
        {annotate, "--success",
         text("MONITOR", in(&Call::annotate, &Call::Annotate::wanted, &Wanted::success)),
         "write next.success: true from the row whose action led to the step at which this monitor "
         "is satisfied for good; in the last row where it is satisfied only at the end"},
        {annotate, "--undecided", undecided(),
         "write false for episodes that the monitor of --success does not decide; without it they "
         "are an error",
         Option::Need::none, "", "--success"},
        {annotate, "--subtasks",
         texts("NAME...", in(&Call::annotate, &Call::Annotate::wanted, &Wanted::subtasks)),
         "write these predicates and lets as subtasks in language_persistent; where several hold, "
         "the last named counts"},
        {annotate, "--between",
         text("TEXT", in(&Call::annotate, &Call::Annotate::wanted, &Wanted::between),
              Wanted().between),
         "the subtask of rows in which none of them holds", Option::Need::none, "", "--subtasks"},
        {annotate, "--progress",
         text("MONITOR", in(&Call::annotate, &Call::Annotate::wanted, &Wanted::progress)),
         "write sarm_progress.parquet: a number from 0 to 1 for each row, by the phases of this "
         "monitor, F (a && F (b && ...))"},
        {annotate, "--list", file(in(&Call::annotate, &Call::Annotate::list)),
         "write a row for each episode as CSV, the worst first, and print the calls of "
         "lerobot-edit-dataset that drop the violated ones; - is standard output"},
        {annotate, "--made", text("FOLDER", in(&Call::annotate, &Call::Annotate::made)),
         "take the samples from the episodes that etlc embed made of the data set"},

        // etlc calibrate, etlc evaluate and etlc crossvalidate
        {calibrate, "-o,--output", file(in(&Call::output)),
         "where to write the thresholds (default: SPEC.thresholds.json beside the spec); - is "
         "standard output"},
        {calibrate, "--thresholds", file(in(&Call::check, &check::Options::thresholds_path)),
         "thresholds of the predicates: with them, calibrate the monitors that are calibrated as a "
         "whole, on other episodes"},
        {calibrate, "--folds", folds(),
         "also report the thresholds without each of N folds of the episodes"},
        {evaluate, "--folds", folds(),
         "calibrate on N - 1 of N folds of the episodes and evaluate on the other, in turn, as "
         "etlc crossvalidate does"},
        {crossvalidate, "--folds", folds(),
         fmt::format("number of folds (default: {})", kUsualFolds)},
        {crossvalidate, "--by",
         choice<bool>({{"hash", false}, {"order", true}}, in(&Call::in_order)),
         "how the episodes are dealt into folds; order: the first episodes only train, and all "
         "later "
         "folds are judged by what the earlier ones trained"},
        {kEvaluate, "--by-episode", flag(in(&Call::evaluate, &Call::Evaluate::by_episode)),
         "also print a row for each episode, the worst first; the CSV then has these rows"},
        {kEvaluate, "--variants", form("KIND,...", read_variants),
         "also judge the monitors on failures made of the episodes: cut, phases_reversed, reversed "
         "or "
         "frozen, separated by commas"},
        {kEvaluate, "--json", file(in(&Call::evaluate, &Call::Evaluate::json)),
         "also write the result as JSON; - is standard output"},
        {kEvaluate, "--csv", file(in(&Call::evaluate, &Call::Evaluate::csv)),
         "also write the result as CSV; - is standard output"},
        {Commands(calibrate) | evaluate, "--shard", form("I/N", read_shard),
         "read only this shard of the episodes, and write a part of the result; etlc merge "
         "combines all parts"},
        {Commands(calibrate) | evaluate, "--part", file(in(&Call::shard, &ShardRequest::part)),
         "with --shard: the part to write"},
        {merge, "-o,--output", file(in(&Call::output)),
         "where to write the result, thresholds or JSON (default: the output of the call)"},

        // etlc report
        {Commands(report) | label, "--frames",
         text("ARRAY|FOLDER|PATTERN",
              in(&Call::report, &Call::Report::frames, &report::FramesOption::text)),
         "camera frames: an array of the episodes (T x H x W x 3 uint8, or T x H x W of grey), the "
         "folder of a data set, or a pattern of PNG or JPEG files, one a step, or of videos, in "
         "which {episode} stands for the episode's name: 'camera/{episode}/*.png'"},
        {Commands(report) | label, "--camera",
         text("NAME", in(&Call::report, &Call::Report::frames, &report::FramesOption::camera)),
         "the camera of a data set whose folder --frames names, or that holds the episodes"},
        {report, "--size",
         number<std::uint64_t>(in(&Call::report, &Call::Report::megabytes), 1, 1000,
                               std::to_string(report::kUsualMegabytes), "MB"),
         "size of the page; what does not fit is left out, starting with the best episodes, and "
         "the page says so"},
        {report, "--no-truths", flag(in(&Call::report, &Call::Report::without_truths)),
         "show the verdicts without comparing them with truths"},
        {report, "-o,--output", file(in(&Call::output)), "the page, an .html file", kRequired},

        // etlc label
        {label, "--labels", only("FILE", in(&Call::labels, &episodes::LabelSources::tables)),
         "table of labels to write, a .csv file (default: labels.csv beside the episodes)"},
        {label, "--port", number<std::uint32_t>(in(&Call::label, &Call::Label::port), 1, 65535),
         "port of the page (default: any free one)"},
        {label, "--proposals", flag(in(&Call::label, &Call::Label::proposals)),
         "print as JSON what the labelled episodes propose for the others, and serve no page"},

        // etlc watch
        {watch, "--video", text("SOURCE", in(&Call::watch, &Call::Watch::video)),
         "what to watch: a camera (/dev/video0), an address (rtsp://..., http://..., tcp://...), a "
         "named pipe, or a video file, at its own speed"},
        {watch, "--trace", checked_trace(), "- watches a trace on standard input, CSV, row by row",
         Option::Need::none, "--video"},
        {watch, "--page", page(),
         "serve a page, on this machine alone, with the frame, the distances and the verdicts "
         "(default: any free port)"},
        {watch, "--record", text("FOLDER", in(&Call::watch, &Call::Watch::record)),
         "write the steps around each alarm into this folder, as etlc incident reads them"},

        // etlc prove
        {Commands(prove) | dossier, "--steps",
         number<std::uint32_t>(in(&Call::prove, &Call::Prove::steps), 1, 10000),
         "length of the longest inputs (default: twice the longest horizon and the longest "
         "buffer, at least 64)"},
        {prove, "--header", file(in(&Call::prove, &Call::Prove::header)),
         "refuse a header that is not, byte for byte, the one that is proved: what this etlc "
         "generates from the spec with the same options"},
        {prove, "--counterexample", text("STEM", in(&Call::prove, &Call::Prove::counterexample)),
         "where to write an input on which the class is wrong, and the spec that reads it: "
         "STEM.csv and STEM.etl (default: SPEC.counterexample in this folder)"},
        {prove, "-o,--output", file(in(&Call::output), "-"),
         "where to write the certificate; - is standard output"},

        // etlc dossier
        {dossier, "-o,--output", text("FOLDER", in(&Call::output)),
         "the folder to write; other files in it stay", kRequired},

        {lsp, "--stdio", flag(in(&Call::on_standard_streams)),
         "accepted for clients that pass it; standard input and output are always used"},
    };
}

}  // namespace

const std::vector<Option>& options() {
    static const std::vector<Option> all = [] {
        std::vector<Option> rows = shared_options();
        for (Option& row : own_options()) rows.push_back(std::move(row));
        return rows;
    }();
    return all;
}

}  // namespace etlc::driver
