#include "driver/compile.hpp"

#include "driver/version.hpp"
#include "emit/emit.hpp"
#include "opt/opt.hpp"
#include "parse/parse.hpp"

namespace etlc::driver {

std::optional<Compiled> compile(const source::File& file, const Request& request, diag::Sink& sink) {
    const ast::Spec spec = parse::parse(file, sink);
    auto model = check::check(spec, file, request.check, sink);
    if (!model || sink.has_errors()) return std::nullopt;
    return compile(std::move(*model), request.limits, sink, request.values);
}

std::optional<Compiled> compile(check::Model model, const plan::Limits& limits, diag::Sink& sink,
                                check::Values values) {
    Compiled result;
    result.model = std::make_unique<check::Model>(std::move(model));
    result.program = std::make_unique<ir::Program>(ir::lower(*result.model));
    opt::optimise(*result.program);
    auto plan = plan::plan(*result.program, limits, sink, values);
    if (!plan) return std::nullopt;
    result.plan = std::move(*plan);
    return result;
}

std::optional<std::string> emit(const source::File& file, const Request& request, diag::Sink& sink,
                                std::vector<std::string>& dependencies) {
    if (request.emit == "ast") {
        const ast::Spec spec = parse::parse(file, sink);
        if (sink.has_errors()) return std::nullopt;
        return ast::print(spec);
    }
    const auto compiled = compile(file, request, sink);
    if (!compiled) return std::nullopt;
    dependencies = compiled->model->dependencies;
    if (request.emit == "graph") return ir::print(*compiled->program);
    if (request.emit == "plan") return plan::print(compiled->plan, compiled->program->graph);
    for (const emit::Backend& backend : emit::backends())
        if (backend.name == request.emit)
            return backend.emit(compiled->plan, compiled->program->graph,
                                {request.name_space, kVersion, request.standalone});
    return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> emittable() {
    std::vector<std::pair<std::string, std::string>> result = {
        {"ast", "the spec as parsed, in canonical form"},
        {"graph", "the formulas in negation normal form, equal ones once"},
        {"plan", "what is computed at every step, in order"},
    };
    for (const emit::Backend& backend : emit::backends()) result.emplace_back(backend.name, backend.summary);
    return result;
}

}  // namespace etlc::driver
