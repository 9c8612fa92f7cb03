#include "plan/program/predicate_values.hpp"

#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/truth.hpp"

namespace etlc::plan {

namespace {

using check::Values;
using etlmon::Value;

etlmon::Truth comparison(const check::Predicate& predicate, float delta, float epsilon,
                         etlmon::Truth range) {
    switch (predicate.comparison) {
        case check::Comparison::less_equal: return etlmon::is_at_most(delta, epsilon, range);
        case check::Comparison::less: return etlmon::is_below(delta, epsilon, range);
        case check::Comparison::greater_equal: return etlmon::is_at_least(delta, epsilon, range);
        case check::Comparison::greater: break;
    }
    return etlmon::is_above(delta, epsilon, range);
}

/// A comparison changes its answer at most once on the way from the least delta to the greatest,
/// and on the way from the least epsilon to the greatest: the corners have all answers.
etlmon::Truth truth_range(const check::Predicate& predicate) {
    const check::Range thresholds = predicate.threshold.range();
    etlmon::Truth range{true, false};
    for (const float delta : {predicate.delta.low, predicate.delta.high})
        for (const float epsilon : {thresholds.low, thresholds.high}) {
            const etlmon::Truth at = comparison(predicate, delta, epsilon, etlmon::kPerhaps);
            range = {range.low && at.low, range.high || at.high};
        }
    if (predicate.missing)
        return {range.low && *predicate.missing, range.high || *predicate.missing};
    return range;
}

Value value_of(etlmon::Truth truth) {
    return {truth.low ? etlmon::kTop : etlmon::kBottom,
            truth.high ? etlmon::kTop : etlmon::kBottom};
}

}  // namespace

Value unseen_range(const check::Predicate& predicate, Values values) {
    if (values == Values::robustness)
        return etlmon::between(predicate.robustness.low, predicate.robustness.high);
    return value_of(truth_range(predicate));
}

namespace {

Value constant(bool truth) {
    return truth ? etlmon::kTrue : etlmon::kFalse;
}

}  // namespace

Value missing_value(const check::Predicate& predicate, Values values) {
    return predicate.missing ? constant(*predicate.missing) : unseen_range(predicate, values);
}

Value missing_value(const check::Input& input) {
    return input.missing ? constant(*input.missing) : Value{etlmon::kBottom, etlmon::kTop};
}

Value value_of(const check::Predicate& predicate, float delta, float epsilon, Values values) {
    const Value missing = missing_value(predicate, values);
    if (values == Values::boolean) {
        const etlmon::Truth otherwise{missing.low == etlmon::kTop, missing.high == etlmon::kTop};
        return value_of(comparison(predicate, delta, epsilon, otherwise));
    }
    return predicate.upper_bound() ? etlmon::at_most(delta, epsilon, missing)
                                   : etlmon::at_least(delta, epsilon, missing);
}

float observed(const check::Predicate& predicate, float epsilon, float distance) {
    const check::Adaptation& adaptation = *predicate.threshold.adaptation;
    return etlmon::adapted(epsilon, comparison(predicate, distance, epsilon, etlmon::kPerhaps),
                           runtime_adaptation(adaptation, predicate.upper_bound()));
}

etlmon::Adaptation runtime_adaptation(const check::Adaptation& adaptation, bool upper_bound) {
    const float sign = upper_bound ? 1.0F : -1.0F;
    return {adaptation.range.low, adaptation.range.high, sign * adaptation.widen,
            -sign * adaptation.tighten, adaptation.grid};
}

Value value_of(const check::Predicate& predicate, const etlmon::Enclosed& delta, float epsilon) {
    const Value missing = missing_value(predicate, Values::robustness);
    return predicate.upper_bound() ? etlmon::at_most(delta, epsilon, missing)
                                   : etlmon::at_least(delta, epsilon, missing);
}

}  // namespace etlc::plan
