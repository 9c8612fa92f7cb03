#include "plan/kernels.hpp"

#include "etlmon/distance/dynamic.hpp"

namespace etlc::plan {

etlmon::MetricId metric_id(const check::Distance& distance) {
    using enum check::Metric;
    switch (distance.metric) {
        case l2: return etlmon::MetricId::l2;
        case l2sq: return etlmon::MetricId::l2sq;
        case l1: return etlmon::MetricId::l1;
        case linf: return etlmon::MetricId::linf;
        case cosine: return etlmon::MetricId::cosine;
        case angular: return etlmon::MetricId::angular;
        case mahalanobis: break;
    }
    return distance.weights_diagonal ? etlmon::MetricId::mahalanobis_diagonal
                                     : etlmon::MetricId::mahalanobis;
}

etlmon::AggregationId aggregation_id(const check::Distance& distance) {
    using enum check::Aggregation;
    switch (distance.aggregation) {
        case min: return etlmon::AggregationId::min;
        case max: return etlmon::AggregationId::max;
        case mean: return etlmon::AggregationId::mean;
        case kth: break;
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

}  // namespace etlc::plan
