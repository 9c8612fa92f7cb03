#include "plan/targets/point_checks.hpp"

#include <algorithm>
#include <set>

#include "plan/program/value_type.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/narrow_targets.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::plan {

std::vector<Index> projected_points(const check::Model& model,
                                    const std::vector<Index>& distances) {
    std::set<Index> points;
    for (const Index d : distances)
        for (Index at = model.distances[d].point; model.points[at].is_projected();
             at = model.points[at].inner)
            points.insert(at);
    return {points.begin(), points.end()};
}

bool checks_point(const Plan& plan, Index distance) {
    return stored_set(plan, distance) == nullptr && narrow_set(plan, distance) == nullptr;
}

bool left_to_kernels(const Plan& plan, Index embedding) {
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
