#include "check/check.hpp"

#include "check/guarantees/retargetable.hpp"
#include "check/steps.hpp"

namespace etlc::check {

namespace {

void check_up_to_inputs(Context& context, ast::Spec& spec) {
    context.incomplete = context.sink.has_errors();
    context.model.file = context.file;
    set_constants(context, spec);
    declare_names(context);
    check_rate(context);
    check_encoders(context);
    check_inputs(context);
}

}  // namespace

std::optional<Model> check(ast::Spec spec, const source::File& file, const Options& options,
                           diag::Sink& sink) {
    Context context{spec, file, options, sink};
    check_up_to_inputs(context, spec);
    check_embeddings(context);
    check_projections(context);
    check_targets(context);
    check_predicates(context);
    check_lets(context);
    check_truths(context);
    check_fitted_frames(context);
    check_fitted_entries(context);
    check_monitors(context);
    choose_telemetry(context);
    check_thresholds(context);
    set_robustness(context);
    warn(context);
    if (options.retargetable) make_retargetable(context);

    if (sink.has_errors() || context.lacks_data) return std::nullopt;
    context.model.dependencies.assign(context.dependencies.begin(), context.dependencies.end());
    return std::move(context.model);
}

std::optional<Model> check_encoded(ast::Spec spec, const source::File& file, const Options& options,
                                   diag::Sink& sink) {
    Context context{spec, file, options, sink};
    check_up_to_inputs(context, spec);
    collect_encoded(context);

    if (sink.has_errors()) return std::nullopt;
    return std::move(context.model);
}

}  // namespace etlc::check
