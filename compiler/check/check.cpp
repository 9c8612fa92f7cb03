#include "check/check.hpp"

#include "check/context/context.hpp"

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

void check_all(Context& context, ast::Spec& spec) {
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
    check_drifts(context);
    choose_telemetry(context);
    check_thresholds(context);
    set_robustness(context);
    warn(context);
    if (context.options.retargetable) make_retargetable(context);
    context.model.dependencies.assign(context.dependencies.begin(), context.dependencies.end());
}

bool is_complete(const Context& context) {
    return !context.sink.has_errors() && !context.lacks_data;
}

}  // namespace

std::optional<Model> check(ast::Spec spec, const source::File& file, const Options& options,
                           diag::Sink& sink) {
    Context context{spec, file, options, sink};
    check_all(context, spec);
    if (!is_complete(context)) return std::nullopt;
    return std::move(context.model);
}

Inspected inspect(ast::Spec spec, const source::File& file, const Options& options,
                  MatrixCache& cache, diag::Sink& sink) {
    Context context{spec, file, options, sink};
    context.cache = &cache;
    check_all(context, spec);
    std::erase_if(cache,
                  [&](const auto& entry) { return !context.matrices.contains(entry.first); });
    Inspected result;
    result.complete = is_complete(context);
    for (std::size_t kind = 0; kind < kNameKinds; ++kind) {
        for (const Entity& entity : context.scope.all(static_cast<NameKind>(kind))) {
            const Reference* found = context.scope.find(entity.name);
            if (found == nullptr || entity.duplicate) continue;
            const bool broken = entity.broken || found->kind == NameKind::unreadable;
            result.names[entity.name] = {found->kind, found->index, broken};
        }
    }
    if (context.step.rate != nullptr) {
        result.step_number = context.step.rate->number.text;
        result.step_unit = context.step.rate->unit;
    }
    result.model = std::move(context.model);
    return result;
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
