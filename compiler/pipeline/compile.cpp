#include "pipeline/compile.hpp"

#include "opt/opt.hpp"
#include "pipeline/alternatives.hpp"

namespace etlc::pipeline {

std::optional<Compiled> compile(check::Model model, const Options& options, diag::Sink& sink) {
    Compiled result;
    result.model = std::make_unique<check::Model>(std::move(model));
    result.program = std::make_unique<ir::Program>(ir::lower(*result.model));
    opt::optimise(*result.program);
    const auto advice = [&](check::Index monitor, plan::Among among) {
        return alternatives(*result.model, monitor, among, options);
    };
    auto plan = plan::plan(*result.program, options.limits, sink, options.values,
                           options.targets_as, advice);
    if (plan && options.recorder)
        plan::add_recorder(*plan, *options.recorder, options.limits, sink);
    if (!plan || sink.has_errors()) return std::nullopt;
    result.plan = std::move(*plan);
    return result;
}

}  // namespace etlc::pipeline
