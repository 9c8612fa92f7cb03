#include "plan/targets/kernels.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "etlmon/distance/between.hpp"
#include "etlmon/hosted/dynamic.hpp"
#include "plan/program/value_type.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

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

using check::Point;

namespace {

void add_point(const check::Model& model, Index index, std::set<Index>& points) {
    if (index == check::kNone || !points.insert(index).second) return;
    add_point(model, model.points[index].inner, points);
    for (const Index part : model.points[index].parts) add_point(model, part, points);
}

/// Adds the parts of a point that kernels do not read as they are.
void add_pointers(const check::Model& model, Index index, std::set<Index>& points) {
    const Point& point = model.points[index];
    if (point.is_delayed()) points.insert(point.inner);
    points.insert(point.parts.begin(), point.parts.end());
}

/// Returns the points that are read through a pointer to their elements.
std::set<Index> pointed_at(const check::Model& model, const std::vector<Index>& distances) {
    std::set<Index> result;
    for (const Index p : points_of(model, distances)) add_pointers(model, p, result);
    for (const Index d : distances)
        if (model.distances[d].is_between_points())
            result.insert({model.distances[d].point, model.distances[d].other});
    return result;
}

template <class Wanted>
std::vector<Index> points_where(const check::Model& model, const std::vector<Index>& distances,
                                const Wanted& wanted) {
    std::vector<Index> points = points_of(model, distances);
    std::erase_if(points, [&](Index p) { return !wanted(p); });
    return points;
}

}  // namespace

std::vector<Index> points_of(const check::Model& model, const std::vector<Index>& distances) {
    std::set<Index> points;
    for (const Index d : distances) {
        add_point(model, model.distances[d].point, points);
        add_point(model, model.distances[d].other, points);
    }
    return {points.begin(), points.end()};
}

std::vector<Index> projected_points(const check::Model& model,
                                    const std::vector<Index>& distances) {
    return points_where(model, distances, [&](Index p) { return model.points[p].is_projected(); });
}

std::vector<Index> built_points(const check::Model& model, const std::vector<Index>& distances) {
    const std::set<Index> pointed = pointed_at(model, distances);
    return points_where(model, distances, [&](Index p) {
        const Point& point = model.points[p];
        return point.is_vector() ? pointed.contains(p) : point.kind != Point::Kind::embedding;
    });
}

std::vector<EarlierPoint> earlier_points(const check::Model& model,
                                         const std::vector<Index>& distances) {
    std::map<Index, std::uint32_t> longest;
    for (const Index p : points_of(model, distances)) {
        const Point& point = model.points[p];
        if (point.is_delayed()) longest[point.inner] = std::max(longest[point.inner], point.steps);
    }
    std::vector<EarlierPoint> result;
    for (const auto& [point, steps] : longest) result.push_back({point, steps});
    return result;
}

std::uint64_t earlier_element_bytes(const check::Model& model, Index index) {
    const Point& point = model.points[index];
    if (point.kind != Point::Kind::embedding) return sizeof(float);
    const check::InputType type = model.inputs[point.inputs[0]].type;
    if (type == check::InputType::i8) return sizeof(std::int8_t);
    return type == check::InputType::f16 ? sizeof(std::uint16_t) : sizeof(float);
}

bool checks_point(const Plan& plan, Index distance) {
    return stored_set(plan, distance) == nullptr && narrow_set(plan, distance) == nullptr;
}

bool left_to_kernels(const Plan& plan, Index embedding) {
    const auto is_it = [&](Index p) {
        const Point& point = plan.model->points[p];
        return point.kind == Point::Kind::embedding && point.inputs[0] == embedding;
    };
    const std::set<Index> pointed = pointed_at(*plan.model, plan.distances);
    if (std::any_of(pointed.begin(), pointed.end(), is_it)) return false;
    const auto leaves = [&](Index d) {
        const check::Point& point = plan.model->point_of(d);
        return point.kind != check::Point::Kind::embedding || point.inputs[0] != embedding ||
               checks_point(plan, d);  // projections check as kernels do
    };
    const check::Input& input = plan.model->inputs[embedding];
    return input.is_embedding() && !input.has_state() &&
           std::all_of(plan.distances.begin(), plan.distances.end(), leaves);
}

bool shares_direction(const Plan& plan, Index embedding) {
    const auto needs = [&](Index d) {
        const check::Point& point = plan.model->point_of(d);
        return point.kind == check::Point::Kind::embedding && point.inputs[0] == embedding &&
               !rows_as_given(plan.model->distances[d]);
    };
    return !value_type(plan.values).on_demand &&
           std::count_if(plan.distances.begin(), plan.distances.end(), needs) > 1;
}

}  // namespace etlc::plan
