#include "plan/targets/kernels.hpp"

#include "etlmon/distance/between.hpp"
#include "etlmon/hosted/dynamic.hpp"

namespace etlc::plan {

etlmon::MetricId metric_id(const check::Distance& distance) {
    if (distance.weights_diagonal) return etlmon::MetricId::mahalanobis_diagonal;
    switch (distance.metric) {
#define DISTANCE(id, Type, prepared, zero_is_unknown) \
    case check::Metric::id:                           \
        return etlmon::MetricId::id;
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
    }
    return etlmon::MetricId::mahalanobis;
}

etlmon::AggregationId aggregation_id(const check::Distance& distance) {
    using check::Aggregation;
    switch (distance.aggregation) {
        case Aggregation::min: return etlmon::AggregationId::min;
        case Aggregation::max: return etlmon::AggregationId::max;
        case Aggregation::mean: return etlmon::AggregationId::mean;
        case Aggregation::kth: break;
    }
    return etlmon::AggregationId::kth;
}

std::vector<float> prepared_rows(const check::Model& model, const check::Distance& distance) {
    const check::Target& target = model.targets[distance.target];
    std::vector<float> rows = target.values;
    etlmon::prepare(metric_id(distance), rows.data(), target.rows, target.dimension);
    return rows;
}

bool rows_as_given(const check::Distance& distance) {
    return etlmon::distance(metric_id(distance)).prepared == etlmon::Prepared::as_given;
}

std::string metric_name(const check::Distance& distance) {
    return etlmon::distance(metric_id(distance)).name;
}

etlmon::Measured measure(const check::Distance& distance, const float* z, const float* targets,
                         std::uint32_t rows, std::uint32_t dimension, float* scratch) {
    return etlmon::measure(metric_id(distance), aggregation_id(distance), distance.kth, z, targets,
                           rows, dimension, distance.weights.data(), scratch);
}

etlmon::Measured measure_between(const check::Distance& distance, const float* a, const float* b,
                                 std::uint32_t dimension, float* scratch) {
    if (!rows_as_given(distance)) {
        if (!etlmon::detail::scale_to_unit(b, dimension, scratch)) return etlmon::kUnmeasured;
        b = scratch;
    }
    return etlmon::measure(metric_id(distance), etlmon::AggregationId::min, 1, a, b, 1, dimension,
                           distance.weights.data(), nullptr);
}

bool project(const check::Projection& map, const std::vector<float>& z, std::vector<float>& y) {
    y.resize(map.rows);
    std::vector<float> centred(map.offset.size());
    return etlmon::project(z.data(), map.matrix.data(),
                           map.offset.empty() ? nullptr : map.offset.data(), map.rows,
                           map.dimension, centred.data(), y.data());
}

}  // namespace etlc::plan
