// The table of all options: first those that several commands share, and those of the compiler.
#include <fmt/format.h>

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "driver/commands/commands.hpp"
#include "driver/options/mistakes.hpp"
#include "driver/options/option.hpp"
#include "driver/options/table.hpp"
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
    Takes takes =
        choice<bool>({{"folder", true}}, in(&Call::labels, &episodes::LabelSources::by_folder));
    takes.usual.clear();
    return takes;
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

        // Specs and files.
        {incident, "file", file(in(&Call::incident, &Call::Incident::file)),
         "file written by write_incident()", kRequired},
        {merge, "parts", texts("PART...", in(&Call::parts)), "the parts, in any order", kRequired},
        {kExecute | kLearn | kClass | embed | report | label | watch, "spec", spec(),
         "the spec, a .etl file", kRequired},
        {incident, "--spec", spec(), "the spec, a .etl file", kRequired},
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
        {kClass | watch, "--recorder", checked(form("B,A,N", read_recorder), mistake_in_recorder),
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
        {Commands(kFindEpisodes) | run, "--episodes", text("PATTERN", in(&Call::groups)),
         "groups of .h5 files that are episodes: 'data/*'"},
        {embed, "--episodes", text("PATTERN", in(&Call::groups)),
         "groups of .h5 files that are recordings: 'data/*'"},
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
         "holds in these, and in no other"},
        {kReadRecordings, "--map", several(form("NAME=OTHER", read_names)),
         "name of an input in the files: --map z=obs/z"},
    };
}

}  // namespace

const std::vector<Option>& options() {
    static const std::vector<Option> all = [] {
        std::vector<Option> rows = make_options();
        for (Option& row : own_options()) rows.push_back(std::move(row));
        return rows;
    }();
    return all;
}

}  // namespace etlc::driver
