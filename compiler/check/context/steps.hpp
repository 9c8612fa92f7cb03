// The steps of check, in the order in which check.cpp runs them.
// Each takes the context, adds its part to the model, and reports what it finds; none depends on
// another having succeeded, only on its having run.
#pragma once

#include "check/context/context.hpp"

namespace etlc::check {

void set_constants(Context& context, ast::Spec& spec);
void declare_names(Context& context);
void check_rate(Context& context);
void check_encoders(Context& context);
void check_inputs(Context& context);
void collect_encoded(Context& context);
void check_embeddings(Context& context);
void check_projections(Context& context);
void check_targets(Context& context);
void check_predicates(Context& context);
void check_lets(Context& context);
void check_truths(Context& context);
void check_fitted_frames(Context& context);
void check_fitted_entries(Context& context);
void check_monitors(Context& context);
void choose_telemetry(Context& context);
void check_thresholds(Context& context);
void set_robustness(Context& context);
void warn(Context& context);

}  // namespace etlc::check
