#include "plan/program/value_type.hpp"

#include "etlmon/hosted/footprint.hpp"
#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/handover.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/sourced.hpp"
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

}  // namespace etlc::plan
