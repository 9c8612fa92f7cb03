#include "driver/options/compile_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "check/names/reserved.hpp"
#include "driver/options/options.hpp"

namespace etlc::driver {

namespace {

/// Why the generated code cannot be in this namespace, a or a::b; empty where it can.
std::string mistake_in_namespace(const std::string& name) {
    bool is_outermost = true;
    for (std::size_t begin = 0; begin != std::string::npos; is_outermost = false) {
        const std::size_t end = name.find("::", begin);
        const std::string part = name.substr(begin, end - begin);
        begin = end == std::string::npos ? end : end + 2;
        const auto in_names = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
        const bool is_name = !part.empty() &&
                             std::isdigit(static_cast<unsigned char>(part[0])) == 0 &&
                             std::all_of(part.begin(), part.end(), in_names);
        if (!is_name) return fmt::format("'{}' is not the name of a namespace", name);
        if (const auto why = check::why_forbidden(part, is_outermost))
            return fmt::format("'{}' {}; another name would do, for example '{}'", part, *why,
                               check::allowed_name(part, "monitors", is_outermost));
    }
    return "";
}

std::string emit_help() {
    std::string text = "print a stage instead of the header:";
    for (const auto& [name, summary] : emittable())
        text += fmt::format("\n{:>30} {}", name + ":", summary);
    return text;
}

}  // namespace

std::string mistake_in_retargetable_call(const CLI::App& app, const Request& request) {
    if (!request.check.retargetable && request.emit != "params") return "";
    const auto without = [&](const char* option, const char* why) {
        return fmt::format("{} goes without {}: {}",
                           request.emit == "params" ? "--emit params" : "--retargetable", option,
                           why);
    };
    if (request.values == check::Values::boolean)
        return without("--values boolean", "its class is made of robustness");
    if (request.explain)
        return without("--explain",
                       "samples of before would be told with the thresholds and rows of now");
    if (request.recorder)
        return without("--recorder",
                       "etlc incident would read an incident with the numbers of one spec");
    if (request.targets_as != plan::Storage::f32)
        return without("--targets-as",
                       "how far narrowing moves a row is known of the rows of one spec");
    for (const char* option : {"--inline-targets", "--targets-file"})
        if (app.get_option_no_throw(option) != nullptr && app.count(option) > 0)
            return without(option, "all of its target sets lie in its parameters");
    return "";
}

void add_compile_options(CLI::App& app, Request& request, OutputPaths& output, bool& check_only) {
    std::vector<std::string> stages;
    for (const auto& [name, summary] : emittable()) stages.push_back(name);
    app.add_option("-o,--output", output.result, "where to write the result; - is standard output")
        ->type_name("FILE");
    app.add_flag("--check", check_only,
                 "diagnostics only; files that are not there yet are no errors");
    app.add_option("--emit", request.emit, emit_help())->type_name("")->check(one_of(stages));
    app.add_flag("--standalone{portable}", request.standalone,
                 "paste the runtime in: one file to copy into firmware, in standard C++ alone; "
                 "--standalone=host: with vectors, chosen by the CPU where there is a choice")
        ->check(one_of({"portable", "host"}));
    app.add_option("--namespace", request.name_space,
                   "of the generated code (default: the spec's name)")
        ->type_name("NAME")
        ->check(
            CLI::Validator([](const std::string& name) { return mistake_in_namespace(name); }, ""));
    app.add_flag("--explain", request.explain,
                 "values that know their sample: why_NAME() says which one decides a verdict, with "
                 "its step, distance, threshold and nearest target");
    app.add_flag(
        "--retargetable", request.check.retargetable,
        "targets, thresholds, projections and numbers lie in STEM.params.bin beside "
        "STEM.hpp; the class takes another such file between steps, made by --emit params");
    app.add_option_function<std::string>(
           "--recorder", [&request](const std::string& text) { request.recorder = recorder(text); },
           "keep the steps around each alarm: BEFORE,AFTER,INCIDENTS, as 2s,1s,4 or 40,20,4; "
           "etlc incident prints what the class writes")
        ->type_name("B,A,N")
        ->check(CLI::Validator(mistake_in_recorder, ""));
    app.add_flag("--lets", request.check.lets,
                 "telemetry of lets too: let_NAME() and robustness_NAME(), of those that do not "
                 "look ahead");
    add_limit(app, "--inline-targets", request.limits.inline_target_bytes,
              "target sets of more bytes are not spelled out in the header, but go to a file "
              "beside it");
    app.add_option("--targets-file", output.targets,
                   "that file (default: STEM.targets.bin beside STEM.hpp, where something goes to "
                   "it); named, it is always written, perhaps empty")
        ->type_name("FILE");
    app.add_option("--depfile", output.depfile,
                   "also write what the output depends on, for make and ninja")
        ->type_name("FILE");
}

std::string mistake_in_compile_call(const CLI::App& app, const Request& request,
                                    const OutputPaths& output, bool check_only) {
    const bool prints_stage = app.count("--emit") > 0;
    if (check_only && (prints_stage || !output.result.empty()))
        return "--check goes neither with --emit nor with -o";
    if (!check_only && !prints_stage && output.result.empty())
        return "say where to write the header with -o, or --check";
    if (!output.depfile.empty() && (output.result.empty() || output.result == "-"))
        return "--depfile needs -o FILE";
    if (app.count("--targets-file") > 0 &&
        (output.targets.empty() || output.targets == "-" || output.targets == output.result ||
         output.targets == output.depfile))
        return "--targets-file needs a file of its own";
    if (request.explain && request.values == check::Values::boolean)
        return "--explain follows robustness to the sample that it is that of, and --values "
               "boolean "
               "has none: leave one of the two out";
    if (const std::string mistake = mistake_in_retargetable_call(app, request); !mistake.empty())
        return mistake;
    if (app.count("--targets-file") > 0 && prints_stage && request.emit != "hpp")
        return "--targets-file goes with the header, not with other stages";
    return "";
}

}  // namespace etlc::driver
