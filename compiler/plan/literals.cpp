#include "plan/literals.hpp"

#include "etlmon/predicate.hpp"
#include "etlmon/truth.hpp"

namespace etlc::plan {

namespace {

using check::Values;
using etlmon::Value;

etlmon::Truth comparison(const check::Predicate& predicate, float delta, etlmon::Truth range) {
    const float epsilon = predicate.threshold.value;
    switch (predicate.comparison) {
        case check::Comparison::less_equal: return etlmon::is_at_most(delta, epsilon, range);
        case check::Comparison::less: return etlmon::is_below(delta, epsilon, range);
        case check::Comparison::greater_equal: return etlmon::is_at_least(delta, epsilon, range);
        case check::Comparison::greater: break;
    }
    return etlmon::is_above(delta, epsilon, range);
}

/// A comparison changes its answer at most once on the way from the least delta to the greatest.
etlmon::Truth truth_range(const check::Predicate& predicate) {
    const etlmon::Truth at_least = comparison(predicate, predicate.delta.low, etlmon::kPerhaps);
    const etlmon::Truth at_most = comparison(predicate, predicate.delta.high, etlmon::kPerhaps);
    return {at_least.low && at_most.low, at_least.high || at_most.high};
}

Value value_of(etlmon::Truth truth) {
    return {truth.low ? etlmon::kTop : etlmon::kBottom, truth.high ? etlmon::kTop : etlmon::kBottom};
}

}  // namespace

Value unseen_range(const check::Predicate& predicate, Values values) {
    if (values == Values::robustness) return etlmon::between(predicate.robustness.low, predicate.robustness.high);
    return value_of(truth_range(predicate));
}

Value literal(const check::Predicate& predicate, float delta, Values values) {
    if (values == Values::boolean) return value_of(comparison(predicate, delta, truth_range(predicate)));
    const Value range = unseen_range(predicate, values);
    return predicate.upper_bound() ? etlmon::at_most(delta, predicate.threshold.value, range)
                                   : etlmon::at_least(delta, predicate.threshold.value, range);
}

}  // namespace etlc::plan
