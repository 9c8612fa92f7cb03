// What predicates come to as values: in robustness, or in truth values.
// Takes: a predicate and its delta. Gives: the value that its literal has at this step, and the one
// that stands for all it may come to. Keeps true: truth values are +inf and -inf, so that
// everything above works on one type; a NaN delta is unknown, which is the whole range.
#pragma once

#include "check/model/model.hpp"
#include "etlmon/distance/enclosed.hpp"
#include "etlmon/temporal/adaptation.hpp"

namespace etlc::plan {

/// The lowest and highest value of a predicate: the range of its robustness or, in truth values,
/// what its comparison can say over the range of its expression and that of its threshold.
etlmon::Value unseen_range(const check::Predicate& predicate, check::Values values);

/// What stands for a predicate at a step that lacks its sample: all it can be, or what the spec
/// says that it counts as.
etlmon::Value missing_value(const check::Predicate& predicate, check::Values values);

/// The same of a bool input.
etlmon::Value missing_value(const check::Input& input);

/// The value of a predicate whose distance or expression came to delta, with the threshold that it
/// has at this step.
etlmon::Value value_of(const check::Predicate& predicate, float delta, float epsilon,
                       check::Values values);
/// Its robustness, where the distance is known within bounds.
etlmon::Value value_of(const check::Predicate& predicate, const etlmon::Enclosed& delta,
                       float epsilon);

/// The threshold of an adaptive predicate after a positive frame of that distance.
float observed(const check::Predicate& predicate, float epsilon, float distance);

/// How it moves, as generated code says it.
etlmon::Adaptation runtime_adaptation(const check::Adaptation& adaptation, bool upper_bound);

}  // namespace etlc::plan
