// `etlc SPEC.etl`: compiles a spec to the files that a build uses.
#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "compile.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "diag/diag.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "emit/emit.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "plan/targets/stored.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

namespace fs = std::filesystem;

/// The output of a call.
struct Output {
    std::string text;                       ///< the stage of --emit
    std::vector<std::string> dependencies;  ///< every file that the spec loads
    Compiled compiled;   ///< for a header: its plan has the content of the file of targets
    std::string params;  ///< content of the file of parameters
};

std::optional<std::string> text_of(const Compiled& compiled, const Request& request) {
    if (request.emit == "graph") return source::visible_lines(ir::print(*compiled.program));
    if (request.emit == "plan") return source::visible_lines(plan::print(compiled.plan));
    for (const emit::Backend& backend : emit::backends())
        if (backend.name == request.emit)
            return backend.emit(compiled.plan,
                                {request.name_space, library::kVersion, request.standalone,
                                 fs::path(request.targets).filename().string()});
    return std::nullopt;
}

/// Refuses large target sets where a header on standard output has no file for them.
void refuse_stored_targets(const Compiled& compiled, diag::Sink& sink) {
    std::set<std::string> seen;
    for (const plan::StoredSet& set : compiled.plan.stored) {
        const plan::StoredNumbers numbers = plan::numbers_of(*compiled.model, set);
        if (!seen.insert(numbers.name).second) continue;
        sink.report(diag::Code::no_file_for_targets, numbers.span,
                    fmt::format("'{}' has {} bytes, too many for the header, and a header on "
                                "standard output has no file beside it",
                                numbers.name, numbers.values.size() * sizeof(float)))
            .note(
                "name the header with -o, the file with --targets-file, or raise --inline-targets");
    }
}

std::optional<Output> output_of(const source::File& file, const Request& request,
                                diag::Sink& sink) {
    Output output;
    if (request.emit == "ast") {
        const ast::Spec spec = parse::parse(file, sink);
        if (sink.has_errors()) return std::nullopt;
        output.text = source::visible_lines(ast::print(spec));
        return output;
    }
    auto compiled = compile(file, request.check, request, sink);
    if (!compiled) return std::nullopt;
    if (request.emit == "hpp" && request.targets.empty()) refuse_stored_targets(*compiled, sink);
    if (sink.has_errors()) return std::nullopt;
    auto text = text_of(*compiled, request);
    if (!text) return std::nullopt;
    output.text = std::move(*text);
    output.dependencies = compiled->model->dependencies;
    if (request.emit == "hpp") {
        if (request.check.retargetable)
            output.params = emit::params(compiled->plan, {.version = library::kVersion});
        output.compiled = std::move(*compiled);
    }
    return output;
}

diag::Failure unreadable(const std::string& path) {
    return {diag::Code::unwritable_output,
            fmt::format("cannot name {}: make and ninja cannot both read this name",
                        data::in_quotes(path))};
}

/// Returns "monitor.hpp: spec.etl targets/a.npy". Fails where make and ninja cannot both read a
/// name.
diag::Result<std::string> dependency_rule(const std::string& output, const std::string& spec,
                                          const std::vector<std::string>& files) {
    const auto target = source::depfile_path(output, source::InRule::target);
    if (!target) return unreadable(output);
    std::string rule = *target + ":";
    std::vector<std::string> prerequisites = files;
    prerequisites.insert(prerequisites.begin(), spec);
    for (const std::string& file : prerequisites) {
        const auto path = source::depfile_path(file, source::InRule::prerequisite);
        if (!path) return unreadable(file);
        rule += (&file == prerequisites.data() ? " " : " \\\n  ") + *path;
    }
    return rule + "\n";
}

bool write(const Output& output, const source::File& spec, const Request& request,
           diag::Sink& sink) {
    std::string rule;
    if (!request.depfile.empty()) {
        auto made = dependency_rule(request.output, spec.path(), output.dependencies);
        if (!made) {
            sink.report(data::in_file(made.failure(), request.depfile));
            return false;
        }
        rule = std::move(*made);
    }
    const plan::Plan& plan = output.compiled.plan;
    const bool has_targets = request.targets_named || !plan.stored.empty();
    std::vector<std::string> inputs = output.dependencies;
    inputs.push_back(spec.path());
    const std::string params = output.params.empty() ? "" : request.params;
    if (!check_outputs(
            {has_targets ? request.targets : "", params, request.depfile, request.output}, inputs,
            sink))
        return false;
    OutputFiles files(sink);
    if (has_targets) {
        const auto write = [&](const std::uint8_t* bytes, std::size_t size) {
            return files.write({reinterpret_cast<const char*>(bytes), size});
        };
        if (!files.begin(request.targets) || !plan::store(plan, write)) return false;
    }
    if (!params.empty() && !files.add(params, output.params)) return false;
    if (!request.depfile.empty() && !files.add(request.depfile, rule)) return false;
    // The result appears last: an interrupted build finds it older than the spec.
    return files.add(request.output, output.text) && files.commit();
}

/// Names monitor.targets.bin and monitor.params.bin for monitor.hpp, in the same folder; none for
/// standard output.
void name_files_beside(Request& request) {
    request.targets_named = !request.targets.empty();
    if (request.output == kStandardOutput) return;
    const fs::path header = request.output;
    const auto beside = [&](const char* ending) {
        return (header.parent_path() / (header.stem().string() + ending)).string();
    };
    request.params = beside(".params.bin");
    if (!request.targets_named) request.targets = beside(".targets.bin");
}

}  // namespace

bool emit(const source::File& file, const Request& request, diag::Sink& sink) {
    Request named = request;
    if (named.output.empty()) named.output = kStandardOutput;
    if (named.emit == "params") named.check.retargetable = true;
    name_files_beside(named);
    const auto output = output_of(file, named, sink);
    return output && !sink.refused() && write(*output, file, named, sink);
}

std::vector<std::pair<std::string, std::string>> emittable() {
    std::vector<std::pair<std::string, std::string>> result = {
        {"ast", "the spec as parsed, in canonical form"},
        {"graph", "the formulas in negation normal form, equal ones once"},
        {"plan", "what is computed at every step, in order"},
    };
    for (const emit::Backend& backend : emit::backends())
        result.emplace_back(backend.name, backend.summary);
    return result;
}

}  // namespace etlc::driver
