#include "plan/program/value_type.hpp"

#include "etlmon/hosted/footprint.hpp"
#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlc::plan {

namespace {

template <class V, class Verdict>
constexpr ValueType row(bool on_demand) {
    return {.on_demand = on_demand,
            .value = sizeof(V),
            .reading = sizeof(etlmon::BasicReading<V>),
            .verdict = sizeof(Verdict),
            .delay = etlmon::delay_bytes<V>,
            .window = etlmon::window_bytes<etlmon::Greatest<V>>,
            .since = etlmon::window_bytes<etlmon::Since<V>>,
            .until = etlmon::window_bytes<etlmon::Until<V>>,
            .handover = etlmon::window_bytes<etlmon::Handover<V>>};
}

}  // namespace

const ValueType& value_type(check::Values values) {
    static constexpr ValueType kRobustness = row<etlmon::Value, etlmon::Verdict>(false);
    static constexpr ValueType kTruth = row<etlmon::Truth, etlmon::BooleanVerdict>(true);
    return values == check::Values::boolean ? kTruth : kRobustness;
}

}  // namespace etlc::plan
