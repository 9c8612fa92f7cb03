// Values of predicates, as robustness or as truth values. Truth values are +inf and -inf, so that
// everything above works on one type; a NaN delta is unknown, which is the whole range.
#pragma once

#include "check/model/model.hpp"
#include "etlmon/distance/enclosed.hpp"
#include "etlmon/temporal/adaptation.hpp"

namespace etlc::plan {

/// Returns the lowest and highest value of a predicate: the range of its robustness, or the
/// possible truth values of its comparison over the ranges of its expression and its threshold.
etlmon::Value unseen_range(const check::Predicate& predicate, check::Values values);

/// Returns the value of a predicate at a step without its sample: its range, or what the spec's
/// `missing` says.
etlmon::Value missing_value(const check::Predicate& predicate, check::Values values);

/// Returns the value of a bool input at a step without its sample.
etlmon::Value missing_value(const check::Input& input);

/// Returns the value of a predicate for a delta and the threshold of this step.
etlmon::Value value_of(const check::Predicate& predicate, float delta, float epsilon,
                       check::Values values);
/// Returns the robustness for a distance known within bounds.
etlmon::Value value_of(const check::Predicate& predicate, const etlmon::Enclosed& delta,
                       float epsilon);

/// Returns the threshold of an adaptive predicate after a positive frame at this distance.
float observed(const check::Predicate& predicate, float epsilon, float distance);

/// Returns the adaptation as generated code states it.
etlmon::Adaptation runtime_adaptation(const check::Adaptation& adaptation, bool upper_bound);

}  // namespace etlc::plan
