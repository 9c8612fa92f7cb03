// The options of single commands, and of few.
#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "data/text/text.hpp"
#include "driver/options/mistakes.hpp"
#include "driver/options/table.hpp"
#include "recordings/open.hpp"

namespace etlc::driver {

namespace {

using enum Command;

constexpr Commands kEncode = Commands(embed) | watch;

Takes suggest() {
    Takes takes = several(form("[PREDICATE...]", read_suggest));
    takes.may_be_empty = true;
    return takes;
}

Takes encoder_timeout() {
    return number<int>(
        in(&Call::embed, &Call::Embed::running, &embed::Running::max_silence_seconds), 1, 86400,
        std::to_string(embed::Running().max_silence_seconds));
}

Takes label_table() {
    return form("FILE", [](Call& call, const Takes::Words& words) {
        return call.labels.tables = words, std::string();
    });
}

Takes folds() {
    return number<std::uint32_t>(in(&Call::folds), 2, 1000);
}

Takes part() {
    return file(in(&Call::shard, &ShardRequest::part));
}

Takes frames() {
    return text("ARRAY|FOLDER|PATTERN",
                in(&Call::report, &Call::Report::frames, &report::FramesOption::text));
}

Takes page_size() {
    return number<std::uint64_t>(in(&Call::report, &Call::Report::megabytes), 1, 1000,
                                 std::to_string(report::kUsualMegabytes), "MB");
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

std::vector<Option> make_own_options() {
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
        {explain, "--at", checked(form("SECONDS", read_seconds), mistake_in_seconds),
         "the step nearest to this time in seconds", Option::Need::none, "--step"},
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
        {kEncode, "--encoder-timeout", encoder_timeout(),
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
        {kEvaluate, "--by-episode", flag(in(&Call::evaluate, &Call::Evaluate::by_episode)),
         "also print a row for each episode, the worst first; the CSV then has these rows"},
        {kEvaluate, "--variants", form("KIND,...", read_variants),
         "also judge the monitors on failures made of the episodes: cut, swapped, reversed or "
         "frozen, separated by commas"},
        {kEvaluate, "--json", file(in(&Call::evaluate, &Call::Evaluate::json)),
         "also write the result as JSON; - is standard output"},
        {kEvaluate, "--csv", file(in(&Call::evaluate, &Call::Evaluate::csv)),
         "also write the result as CSV; - is standard output"},
        {Commands(calibrate) | evaluate, "--shard", form("I/N", read_shard),
         "read only this shard of the episodes, and write a part of the result; etlc merge "
         "combines all parts"},
        {Commands(calibrate) | evaluate, "--part", part(), "with --shard: the part to write"},
        {merge, "-o,--output", file(in(&Call::output)),
         "where to write the result, thresholds or JSON (default: the output of the call)"},

        // etlc report
        {Commands(report) | label, "--frames", frames(),
         "camera frames: an array of the episodes (T x H x W x 3 uint8, or T x H x W of grey), the "
         "folder of a data set, or a pattern of PNG or JPEG files, one a step, or of videos, in "
         "which {episode} stands for the episode's name: 'camera/{episode}/*.png'"},
        {Commands(report) | label, "--camera",
         text("NAME", in(&Call::report, &Call::Report::frames, &report::FramesOption::camera)),
         "the camera of a data set whose folder --frames names, or that holds the episodes"},
        {report, "--size", page_size(),
         "size of the page; what does not fit is left out, starting with the best episodes, and "
         "the page says so"},
        {report, "--no-truths", flag(in(&Call::report, &Call::Report::without_truths)),
         "show the verdicts without comparing them with truths"},
        {report, "-o,--output", file(in(&Call::output)), "the page, an .html file", kRequired},

        // etlc label
        {label, "--labels", label_table(),
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
        {prove, "--steps", number<std::uint32_t>(in(&Call::prove, &Call::Prove::steps), 1, 10000),
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

        {lsp, "--stdio", flag(in(&Call::on_standard_streams)),
         "accepted for clients that pass it; standard input and output are always used"},
    };
}

}  // namespace

std::vector<Option> own_options() {
    return make_own_options();
}

}  // namespace etlc::driver
