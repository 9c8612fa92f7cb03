#include "plan/decide/point_checks.hpp"

#include <algorithm>

#include "plan/kernels.hpp"
#include "plan/narrow_targets.hpp"
#include "plan/program/value_type.hpp"
#include "plan/stored.hpp"

namespace etlc::plan {

bool checks_point(const Plan& plan, Index distance) {
    return stored_set(plan, distance) == nullptr && narrow_set(plan, distance) == nullptr;
}

bool left_to_kernels(const Plan& plan, Index embedding) {
    const auto leaves = [&](Index d) {
        const check::Distance& distance = plan.model->distances[d];
        return distance.point_is_vector || distance.point[0] != embedding || checks_point(plan, d);
    };
    const check::Input& input = plan.model->inputs[embedding];
    return input.is_embedding() && input.hold == 0 &&
           std::all_of(plan.distances.begin(), plan.distances.end(), leaves);
}

bool shares_direction(const Plan& plan, Index embedding) {
    const auto needs = [&](Index d) {
        const check::Distance& distance = plan.model->distances[d];
        return !distance.point_is_vector && distance.point[0] == embedding &&
               !rows_as_given(distance);
    };
    return !value_type(plan.values).on_demand &&
           std::count_if(plan.distances.begin(), plan.distances.end(), needs) > 1;
}

}  // namespace etlc::plan
