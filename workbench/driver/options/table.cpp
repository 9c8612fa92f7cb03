// The table of all options.
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "data/recordings/open.hpp"
#include "driver/options/forms.hpp"
#include "driver/options/option.hpp"

namespace etlc::driver {

namespace {

using enum Command;

constexpr Commands kExecute = Commands(run) | explain;
constexpr Commands kEvaluate = Commands(evaluate) | crossvalidate;
/// Whatever plans monitors.
constexpr Commands kPlan = kExecute | kEvaluate | compile | incident | report;
constexpr Commands kLearn = Commands(fit) | calibrate;
constexpr Commands kReadEpisodes = kLearn | kEvaluate | report;
constexpr Commands kReadRecordings = kReadEpisodes | kExecute | embed;
constexpr Commands kReadSpec = kPlan | kLearn | embed;

constexpr auto kRequired = Option::Need::required;

template <auto place>
auto at() {
    return [](Call & call) -> auto& {
        return (call.*place)();
    };
}

Takes limit(std::uint64_t plan::Limits::*bytes) {
    return number<std::uint64_t>(in(&Call::request, &Request::limits, bytes), 0,
                                 std::numeric_limits<std::uint64_t>::max(),
                                 std::to_string(plan::Limits().*bytes));
}

Takes checked(Takes takes, std::string (*check)(const std::string&)) {
    takes.check = check;
    return takes;
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
    return one_of(std::move(names), in(&Call::request, &Request::emit));
}

Takes warnings() {
    Takes takes = texts("error", in(&Call::warnings));
    takes.choices = {"error"};
    takes.check = [](const std::string& found) { return mistake_in_word(found, {"error"}); };
    return takes;
}

Takes standalone() {
    Takes takes = one_of({"portable", "host"}, in(&Call::request, &Request::standalone));
    takes.usual.clear();
    takes.is_flag = true;
    return takes;
}

Takes several(Takes takes) {
    takes.repeats = true;
    return takes;
}

Takes settings() {
    Takes takes = several(form("NAME=VALUE", read_settings));
    takes.once_a_name = true;
    return takes;
}

Takes suggest() {
    Takes takes = several(form("[PREDICATE...]", read_suggest));
    takes.may_be_empty = true;
    return takes;
}

Takes retargetable() {
    return flag(in(&Call::request, &Request::check, &check::Options::retargetable));
}

Takes lets() {
    return flag(in(&Call::request, &Request::check, &check::Options::lets));
}

Takes encoder_timeout() {
    return number<int>(in(&Call::embed, &EmbedRequest::embed, &embed::Request::running,
                          &embed::Running::max_silence_seconds),
                       1, 86400, std::to_string(embed::Running().max_silence_seconds));
}

Takes folds() {
    return number<std::uint32_t>(at<&Call::folds>(), 2, 1000);
}

Takes part() {
    return file([](Call& call) -> std::string& { return call.shard().part; });
}

Takes frames() {
    return text("ARRAY|PATTERN", in(&Call::report, &ReportRequest::report, &report::Request::frames,
                                    &report::FramesOption::text));
}

Takes page_size() {
    return number<std::uint64_t>(
        in(&Call::report, &ReportRequest::report, &report::Request::megabytes), 1, 1000,
        std::to_string(report::kUsualMegabytes), "MB");
}

Takes spec() {
    return form("SPEC.etl", [](Call& call, const std::vector<std::string>& words) {
        call.specs = words;
        return std::string();
    });
}

std::vector<Option> make_options() {
    return {
        {kReadSpec | merge | lsp, "-h,--help", Takes(), "Print this help message and exit"},
        {compile, "--version", Takes(), "Display program version information and exit"},

        // What is read.
        {incident, "file", file(in(&Call::incident, &IncidentRequest::file)),
         "what write_incident() gave", kRequired},
        {merge, "parts", texts("PART...", in(&Call::parts)), "the parts, in any order", kRequired},
        {kExecute | kLearn | compile | embed | report, "spec", spec(), "the spec, a .etl file",
         kRequired},
        {incident, "--spec", spec(), "the spec, a .etl file", kRequired},
        {kEvaluate, "spec", texts("SPEC.etl", in(&Call::specs)),
         "the specs, .etl files; several are set side by side", kRequired},

        // How findings are told.
        {kReadSpec, "-W", warnings(), "-Werror: warnings are errors"},
        {kReadSpec, "--diagnostics", one_of({"text", "json"}, in(&Call::diagnostics), "text"),
         "how to print them"},

        // What becomes of the spec.
        {kReadSpec, "--set", settings(),
         "another value for a constant: --set limit=0.25, --set deadline=2s"},
        {kPlan, "--thresholds", file(at<&Call::thresholds>()),
         "calibrated thresholds (default: SPEC.thresholds.json beside the spec, where it exists)"},
        {kPlan | calibrate, "--fitted", file(at<&Call::fitted>()),
         "what 'etlc fit' found (default: SPEC.fitted.npz beside the spec, where it exists)"},
        {kPlan | kLearn, "--embedded", file(at<&Call::embedded>()),
         "what 'etlc embed' made of images and videos (default: SPEC.embedded.npz beside the "
         "spec)"},
        {kPlan, "--values",
         choice<check::Values>(
             {{"robustness", check::Values::robustness}, {"boolean", check::Values::boolean}},
             in(&Call::request, &Request::values)),
         "what monitors compute with; boolean: truth values, and only what can still change a "
         "verdict"},
        {kPlan, "--targets-as",
         choice<plan::Storage>(
             {{"f32", plan::Storage::f32}, {"f16", plan::Storage::f16}, {"i8", plan::Storage::i8}},
             in(&Call::request, &Request::targets_as)),
         "how target sets are stored for measuring; what that leaves open is measured in float32 "
         "as well"},
        {kPlan, "--max-state", limit(&plan::Limits::state_bytes), "most bytes of state"},
        {kPlan, "--max-code", limit(&plan::Limits::code_bytes),
         "most bytes of code, estimated, targets aside"},
        {kPlan, "--max-work", limit(&plan::Limits::operations),
         "most operations of the temporal part a step"},

        // What is made of it.
        {compile, "-o,--output", file(at<&Call::written>()),
         "where to write the result; - is standard output"},
        {compile, "--check", flag(in(&Call::check_only)),
         "diagnostics only; files that are not there yet are no errors"},
        {compile, "--emit", stages(), emit_help()},
        {compile, "--standalone{portable}", standalone(),
         "paste the runtime in: one file to copy into firmware, in standard C++ alone; "
         "--standalone=host: with vectors, chosen by the CPU where there is a choice"},
        {compile, "--namespace",
         checked(text("NAME", in(&Call::request, &Request::name_space)), mistake_in_namespace),
         "of the generated code (default: the spec's name)"},
        {compile, "--explain", flag(in(&Call::request, &Request::explain)),
         "values that know their sample: why_NAME() says which one decides a verdict, with its "
         "step, distance, threshold and nearest target"},
        {compile, "--retargetable", retargetable(),
         "targets, thresholds, projections and numbers lie in STEM.params.bin beside STEM.hpp; the "
         "class takes another such file between steps, made by --emit params"},
        {compile, "--recorder", checked(form("B,A,N", read_recorder), mistake_in_recorder),
         "keep the steps around each alarm: BEFORE,AFTER,INCIDENTS, as 2s,1s,4 or 40,20,4; etlc "
         "incident prints what the class writes"},
        {compile, "--lets", lets(),
         "telemetry of lets too: let_NAME() and robustness_NAME(), of those that do not look "
         "ahead"},
        {compile, "--inline-targets", limit(&plan::Limits::inline_target_bytes),
         "target sets of more bytes are not spelled out in the header, but go to a file beside it"},
        {compile, "--targets-file", file(in(&Call::output, &OutputPaths::targets)),
         "that file (default: STEM.targets.bin beside STEM.hpp, where something goes to it); "
         "named, it is always written, perhaps empty"},
        {compile, "--depfile", file(in(&Call::output, &OutputPaths::depfile)),
         "also write what the output depends on, for make and ninja"},

        // Recordings.
        {kReadEpisodes, "--data", texts("FILE...", at<&Call::data>()),
         "episodes: files (" + data::trace_endings() + "), folders, data sets, 'patterns'",
         kRequired},
        {embed, "--data", texts("FILE...", at<&Call::data>()),
         "recordings to make episodes of: videos, folders of images, data sets, .npz and .h5 files "
         "of images, folders and 'patterns' of these"},
        {run, "--trace", file(at<&Call::trace>()),
         "the trace: .csv, .npz or .h5; FILE.h5:GROUP is the episode in a group of it, FOLDER:3 "
         "one of a data set; - is CSV on standard input, a step as soon as its row is there",
         kRequired},
        {explain, "--trace", file(at<&Call::trace>()),
         "the trace: .csv, .npz or .h5; FILE.h5:GROUP is the episode in a group of it, FOLDER:3 "
         "one of a data set",
         kRequired},
        {embed, "--camera", several(form("[INPUT=]NAME", read_cameras)),
         "the camera of a data set, or the array of images: observation.images.top; where inputs "
         "have different ones, z=observation.images.top"},
        {kReadEpisodes, "--episodes", text("PATTERN", at<&Call::groups>()),
         "groups of .h5 files that are episodes: 'data/*'"},
        {embed, "--episodes", text("PATTERN", at<&Call::groups>()),
         "groups of .h5 files that are recordings: 'data/*'"},
        {kReadEpisodes, "--allow-overlap",
         checked(text("REASON", at<&Call::allow_overlap>()), mistake_in_reason),
         "why episodes may share most of their content, or hold targets, and still count; it is "
         "written into the result"},
        {kReadEpisodes, "-j,--jobs", number<unsigned>(at<&Call::jobs>(), 1, 1024),
         "threads (default: as many as the machine has)"},
        {kReadRecordings, "--map", several(form("NAME=OTHER", read_names)),
         "what an input is called in the files: --map z=obs/z"},

        // etlc run
        {run, "-o,--output", file(at<&Call::written>(), "-"),
         "where to write the verdicts, as CSV; - is standard output"},
        {run, "--finish", flag(in(&Call::run, &RunRequest::finish)),
         "after the trace, also report the last positions of sliding monitors"},
        {run, "--distances", flag(in(&Call::run, &RunRequest::distances)),
         "a column for each predicate: the distance or expression that it compares"},
        {run, "--lets", lets(),
         "a column for each let that does not look ahead: its robustness at that step"},
        {run, "--retargetable", retargetable(),
         "bounds as a class of --retargetable has them: for any numbers that may come"},
        {run, "--summary", flag(in(&Call::run, &RunRequest::summary)),
         "a line for each monitor, and for inputs with missing samples, on standard output; the "
         "rows are written only where -o says"},
        {run, "--html", file(in(&Call::run, &RunRequest::html)),
         "also a page of the trace to look at; rows then as with --summary"},
        {run, "--svg", file(in(&Call::run, &RunRequest::svg)),
         "also a picture of its timelines; rows then as with --summary"},

        // etlc explain
        {explain, "--monitor", text("NAME", in(&Call::explain, &ExplainRequest::monitor)),
         "which (default: the first that raises an alarm, else the first)"},
        {explain, "--step", number<std::uint32_t>(in(&Call::explain, &ExplainRequest::step)),
         "the verdict after this step (default: after that of the first alarm, else the first that "
         "is final, else the last); of a sliding monitor also steps after the trace, as etlc run "
         "--finish has them"},
        {explain, "--at", checked(form("SECONDS", read_seconds), mistake_in_seconds),
         "the same in seconds, to the nearest step", Option::Need::none, "--step"},
        {explain, "--format",
         choice<ExplanationFormat>(
             {{"text", ExplanationFormat::text}, {"json", ExplanationFormat::json}},
             in(&Call::explain, &ExplainRequest::format)),
         "for people, or for programs"},
        {incident, "--format",
         choice<IncidentFormat>({{"table", IncidentFormat::table},
                                 {"csv", IncidentFormat::csv},
                                 {"trace", IncidentFormat::trace},
                                 {"spec", IncidentFormat::spec}},
                                in(&Call::incident, &IncidentRequest::format)),
         "trace: what was measured, as a .csv file for etlc run and etlc explain; spec: the spec "
         "that reads that trace, with what was measured for inputs"},
        {Commands(explain) | incident, "-o,--output", file(at<&Call::written>(), "-"),
         "where to write it; - is standard output"},

        // etlc embed
        {embed, "-o,--output", text("FOLDER", at<&Call::written>()),
         "folder where the episodes go, as .npz"},
        {embed, "--embedded", file(at<&Call::embedded>()),
         "where what the spec names goes, encoded (default: SPEC.embedded.npz beside the spec)"},
        {embed, "--shard", form("I/N", read_shard),
         "make episodes of this shard of the recordings only; the first encodes what the spec "
         "names as well"},
        {embed, "--onnxruntime",
         text("PATH", in(&Call::embed, &EmbedRequest::embed, &embed::Request::running,
                         &embed::Running::onnxruntime)),
         "what runs the models of encoders: the library, or a folder that has it (default: "
         "ETLC_ONNXRUNTIME, or where pip, npm or the system put it)"},
        {embed, "--encoder-cmd",
         text("COMMAND", in(&Call::embed, &EmbedRequest::embed, &embed::Request::running,
                            &embed::Running::command)),
         "a command that encodes: frames on its standard input, embeddings on its standard output "
         "(docs/encoders.md)",
         Option::Need::none, "--onnxruntime"},
        {embed, "--encoder-timeout", encoder_timeout(),
         "seconds after which an encoder that neither reads nor writes is stopped"},

        // etlc fit
        {fit, "-o,--output", file(at<&Call::written>()),
         "where to write what is fitted (default: SPEC.fitted.npz beside the spec); - is standard "
         "output"},
        {fit, "--suggest", suggest(),
         "try distances, targets and projections for these predicates (default: all with labels) "
         "and print\nhow well each separates, with the lines to paste; nothing is written",
         Option::Need::none, "--output"},
        {fit, "--json", flag(in(&Call::fit, &FitRequest::json)), "with --suggest: for programs",
         Option::Need::none, "", "--suggest"},

        // etlc calibrate, etlc evaluate and etlc crossvalidate
        {calibrate, "-o,--output", file(at<&Call::written>()),
         "where to write the thresholds (default: SPEC.thresholds.json beside the spec); - is "
         "standard output"},
        {calibrate, "--thresholds", file(at<&Call::thresholds>()),
         "the thresholds of the predicates: then the monitors that are calibrated as a whole are, "
         "on episodes that these thresholds have not seen"},
        {calibrate, "--folds", folds(),
         "also say what the thresholds would be without each of N folds of the episodes"},
        {evaluate, "--folds", folds(),
         "calibrate on N - 1 of N folds of the episodes and evaluate on the other, in turn, as "
         "etlc crossvalidate does"},
        {crossvalidate, "--folds", folds(),
         fmt::format("how many folds (default: {})", kUsualFolds)},
        {kEvaluate, "--by-episode", flag(in(&Call::evaluate, &EvaluateRequest::by_episode)),
         "also a row an episode, the worst first; the CSV then has these rows"},
        {kEvaluate, "--json", file(in(&Call::evaluate, &EvaluateRequest::json)),
         "also write the result as JSON; - is standard output"},
        {kEvaluate, "--csv", file(in(&Call::evaluate, &EvaluateRequest::csv)),
         "also write the result as CSV; - is standard output"},
        {Commands(calibrate) | evaluate, "--shard", form("I/N", read_shard),
         "read only this shard of the episodes, and write a part of the result; etlc merge makes "
         "the result of all parts"},
        {Commands(calibrate) | evaluate, "--part", part(), "with --shard: the part to write"},
        {merge, "-o,--output", file(at<&Call::written>()),
         "where the result goes (default: where the call says): thresholds, or JSON"},

        // etlc report
        {report, "--frames", frames(),
         "what the camera saw: an array of the episodes (T x H x W x 3 uint8), or a pattern of PNG "
         "or JPEG files, one a step, or of videos, in which {episode} stands for the episode's "
         "name: 'camera/{episode}/*.png'"},
        {report, "--size", page_size(),
         "the size of the page; what does not fit is left out, best episodes first, and the page "
         "says so"},
        {report, "--no-truths", flag(in(&Call::report, &ReportRequest::without_truths)),
         "show what the monitors say, and compare it with nothing"},
        {report, "-o,--output", file(at<&Call::written>()), "the page, an .html file", kRequired},

        {lsp, "--stdio", flag(in(&Call::on_standard_streams)),
         "that is how it speaks anyway; some clients say it"},
    };
}

}  // namespace

const std::vector<Option>& options() {
    static const std::vector<Option> all = make_options();
    return all;
}

}  // namespace etlc::driver
