#include "plan/evaluate/tables.hpp"

#include <algorithm>

#include "plan/program/reading.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"

namespace etlc::plan {

namespace {

/// Finds what a point of `ago` steps before rests on, and how long ago. Calibration also needs what
/// a delayed point was projected from.
void keep_for(const check::Model& model, Index index, std::uint32_t ago,
              std::map<Index, std::uint32_t>& longest) {
    const check::Point& point = model.points[index];
    if (!point.is_delayed() && ago > 0) longest[index] = std::max(longest[index], ago);
    if (point.inner != kNone) keep_for(model, point.inner, ago + point.steps, longest);
    for (const Index part : point.parts) keep_for(model, part, ago, longest);
}

}  // namespace

Tables::Tables(const Plan& plan) {
    const check::Model& model = *plan.model;
    for (const Stream& stream : plan.streams)
        if (stream.op == StreamOp::flag) flags.push_back(stream.index);
    measured_points = points_of(model, plan.distances);
    take_shape(plan);
    for (const Index p : measured_points)
        if (model.points[p].is_projected())
            centred = std::max<std::size_t>(
                centred, model.projections[model.points[p].projection].dimension);
    prepared.resize(model.distances.size());
    widened.resize(model.distances.size());
    narrow.resize(model.distances.size());
    for (const Index d : plan.distances) prepare(plan, d);
    for (const check::Predicate& predicate : model.predicates)
        contrast_cuts.push_back(plan::contrast_cuts(plan, predicate));
}

void Tables::take_shape(const Plan& plan) {
    std::map<Index, std::uint32_t> longest;
    for (const Index p : measured_points) keep_for(*plan.model, p, 0, longest);
    for (const auto& [point, steps] : longest) shape.kept.push_back({point, steps + 1});
    for (const Stream& stream : plan.streams) shape.streams.push_back(members_of(stream));
    for (const Reading& reading : plan.readings) {
        std::vector<Value>& first = shape.registers.emplace_back();
        if (reading.kind == Reading::Kind::pending || reading.kind == Reading::Kind::table)
            continue;
        for (const Member& member : members_of(reading)) first.push_back(member.first);
    }
}

void Tables::prepare(const Plan& plan, Index d) {
    const check::Model& model = *plan.model;
    const check::Distance& distance = model.distances[d];
    scratch = std::max<std::size_t>(scratch, distance.kth);
    if (distance.is_between_points()) {
        scratch = std::max<std::size_t>(scratch, model.dimension_of(d));
        return;
    }
    prepared[d] = prepared_rows(model, distance);
    if (distance.full_weights() && distance.aggregation == check::Aggregation::min) {
        near.try_emplace(d, distance, model.targets[distance.target]);
        near_values = std::max(near_values, prepared[d].size());
    }
    narrow[d] = narrow_set(plan, d);
    if (narrow[d] != nullptr) widened[d] = widened_rows(*narrow[d]);
}

}  // namespace etlc::plan
