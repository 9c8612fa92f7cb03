#include "driver/compile/compile.hpp"

#include <fmt/format.h>

#include <set>

#include "emit/emit.hpp"
#include "library/open.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "plan/targets/stored.hpp"
#include "source/escape.hpp"

namespace etlc::driver {

std::optional<Compiled> compile(const source::File& file, const Request& request,
                                diag::Sink& sink) {
    return library::compile(file, request.check, request, sink);
}

namespace {

std::optional<std::string> text_of(const Compiled& compiled, const Request& request) {
    if (request.emit == "graph") return source::visible_lines(ir::print(*compiled.program));
    if (request.emit == "plan") return source::visible_lines(plan::print(compiled.plan));
    for (const emit::Backend& backend : emit::backends())
        if (backend.name == request.emit)
            return backend.emit(compiled.plan, {request.name_space, library::kVersion,
                                                request.standalone, request.targets_file});
    return std::nullopt;
}

/// A header on standard output has no file beside it, unless the call names one.
void refuse_stored_targets(const Compiled& compiled, diag::Sink& sink) {
    std::set<std::string> seen;
    for (const plan::StoredSet& set : compiled.plan.stored) {
        const plan::StoredNumbers numbers = plan::numbers_of(*compiled.model, set);
        if (!seen.insert(numbers.name).second) continue;
        sink.report(diag::Code::no_file_for_targets, numbers.span,
                    fmt::format("'{}' takes {} bytes, too many to be spelled out, and a header on "
                                "standard output has no file beside it",
                                numbers.name, numbers.values.size() * sizeof(float)))
            .note(
                "name the header with -o, the file with --targets-file, or raise --inline-targets");
    }
}

}  // namespace

std::optional<Output> emit(const source::File& file, const Request& request, diag::Sink& sink) {
    Output output;
    if (request.emit == "ast") {
        const ast::Spec spec = parse::parse(file, sink);
        if (sink.has_errors()) return std::nullopt;
        output.text = source::visible_lines(ast::print(spec));
        return output;
    }
    auto compiled = compile(file, request, sink);
    if (!compiled) return std::nullopt;
    if (request.emit == "hpp" && request.targets_file.empty())
        refuse_stored_targets(*compiled, sink);
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
