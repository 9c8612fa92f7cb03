#include "plan/program/value_type.hpp"

#include "etlmon/hosted/footprint.hpp"
#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/equality.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/sourced.hpp"
#include "etlmon/temporal/truth.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlc::plan {

namespace {

template <class V, class Verdict>
constexpr ValueType row(bool on_demand, bool sourced) {
    return {.on_demand = on_demand,
            .sourced = sourced,
            .value = sizeof(V),
            .reading = sizeof(etlmon::BasicReading<V>),
            .verdict = sizeof(Verdict),
            .delay = etlmon::delay_bytes<V>,
            .window = etlmon::window_bytes<etlmon::Greatest<V>>,
            .since = etlmon::window_bytes<etlmon::Since<V>>,
            .until = etlmon::window_bytes<etlmon::Until<V>>,
            .handover = etlmon::window_bytes<etlmon::Handover<V>>,
            .count = etlmon::count_bytes<V>};
}

}  // namespace

const ValueType& value_type(check::Values values) {
    static constexpr ValueType kRobustness = row<etlmon::Value, etlmon::Verdict>(false, false);
    static constexpr ValueType kTruth = row<etlmon::Truth, etlmon::BooleanVerdict>(true, false);
    static constexpr ValueType kSourced = row<etlmon::Sourced, etlmon::Verdict>(false, true);
    switch (values) {
        case check::Values::robustness: break;
        case check::Values::boolean: return kTruth;
        case check::Values::sourced: return kSourced;
    }
    return kRobustness;
}

namespace {

using check::Values;
using etlmon::Value;

etlmon::Truth comparison(const check::Predicate& predicate, float delta, float epsilon,
                         const std::optional<float>& inner, etlmon::Truth range) {
    if (inner) switch (predicate.comparison) {
            case check::Comparison::less_equal:
                return etlmon::is_at_most(delta, *inner, epsilon, range);
            case check::Comparison::less: return etlmon::is_below(delta, *inner, epsilon, range);
            case check::Comparison::greater_equal:
                return etlmon::is_at_least(delta, *inner, epsilon, range);
            default: return etlmon::is_above(delta, *inner, epsilon, range);
        }
    switch (predicate.comparison) {
        case check::Comparison::less_equal: return etlmon::is_at_most(delta, epsilon, range);
        case check::Comparison::less: return etlmon::is_below(delta, epsilon, range);
        case check::Comparison::greater_equal: return etlmon::is_at_least(delta, epsilon, range);
        case check::Comparison::greater: return etlmon::is_above(delta, epsilon, range);
        case check::Comparison::equal: return etlmon::is_equal(delta, epsilon, range);
        case check::Comparison::not_equal: break;
    }
    return etlmon::is_unequal(delta, epsilon, range);
}

etlmon::Truth truth_range(const check::Predicate& predicate) {
    const auto answer = predicate.constant_answer();
    const etlmon::Truth range = answer ? etlmon::truth_of(*answer) : etlmon::kPerhaps;
    if (!predicate.missing) return range;
    return {range.low && *predicate.missing, range.high || *predicate.missing};
}

Value constant(bool truth) {
    return truth ? etlmon::kTrue : etlmon::kFalse;
}

Value value_of(etlmon::Truth truth) {
    return {truth.low ? etlmon::kTop : etlmon::kBottom,
            truth.high ? etlmon::kTop : etlmon::kBottom};
}

}  // namespace

Value unseen_range(const check::Predicate& predicate, Values values) {
    if (values != Values::boolean)
        return etlmon::between(predicate.robustness.low, predicate.robustness.high);
    return value_of(truth_range(predicate));
}

Value missing_value(const check::Predicate& predicate, Values values) {
    return predicate.missing ? constant(*predicate.missing) : unseen_range(predicate, values);
}

Value missing_value(const check::Input& input) {
    return input.missing ? constant(*input.missing) : Value{etlmon::kBottom, etlmon::kTop};
}

Value value_of(const check::Predicate& predicate, float delta, float epsilon,
               const std::optional<float>& inner, Values values) {
    const Value missing = missing_value(predicate, values);
    if (values == Values::boolean || predicate.equality()) {
        const etlmon::Truth otherwise{missing.low == etlmon::kTop, missing.high == etlmon::kTop};
        return value_of(comparison(predicate, delta, epsilon, inner, otherwise));
    }
    if (inner)
        return predicate.upper_bound() ? etlmon::at_most(delta, *inner, epsilon, missing)
                                       : etlmon::at_least(delta, *inner, epsilon, missing);
    return predicate.upper_bound() ? etlmon::at_most(delta, epsilon, missing)
                                   : etlmon::at_least(delta, epsilon, missing);
}

float observed(const check::Predicate& predicate, float epsilon, float distance) {
    const check::Adaptation& adaptation = *predicate.threshold.adaptation;
    return etlmon::adapted(epsilon, comparison(predicate, distance, epsilon, {}, etlmon::kPerhaps),
                           runtime_adaptation(adaptation, predicate.upper_bound()));
}

etlmon::Adaptation runtime_adaptation(const check::Adaptation& adaptation, bool upper_bound) {
    const float sign = upper_bound ? 1.0F : -1.0F;
    return {adaptation.range.low, adaptation.range.high, sign * adaptation.widen,
            -sign * adaptation.tighten, adaptation.grid};
}

Value value_of(const check::Predicate& predicate, const etlmon::Enclosed& delta, float epsilon) {
    const Value missing = missing_value(predicate, Values::robustness);
    if (const std::optional<float>& inner = predicate.threshold.inner)
        return predicate.upper_bound() ? etlmon::at_most(delta, *inner, epsilon, missing)
                                       : etlmon::at_least(delta, *inner, epsilon, missing);
    return predicate.upper_bound() ? etlmon::at_most(delta, epsilon, missing)
                                   : etlmon::at_least(delta, epsilon, missing);
}

}  // namespace etlc::plan
