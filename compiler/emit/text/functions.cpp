#include "emit/text/functions.hpp"

#include <fmt/format.h>

#include "plan/program/value_type.hpp"

namespace etlc::emit {

std::set<std::string> function_names(const plan::Plan& plan) {
    const check::Model& model = *plan.model;
    std::set<std::string> names{"max_of", "min_of"};
    for (check::Index p : plan.predicates)
        for (const char* prefix : {"distance_", "nearest_", "threshold_", "unseen_",
                                   "initial_threshold_", "set_threshold_", "observe_"})
            names.insert(prefix + model.predicates[p].name);
    if (plan::value_type(plan.values).sourced)
        for (const plan::Monitor& monitor : plan.monitors) names.insert("why_" + monitor.name);
    for (const plan::Monitor& monitor : plan.monitors)
        for (const char* prefix : {"restart_", "alarms_", "fulfilled_"})
            if (monitor.restarts != check::Restarts::never) names.insert(prefix + monitor.name);
    for (check::Index p : plan.predicates)
        for (check::Index d : check::measured_targets(model, model.predicates[p]))
            names.insert(fmt::format("nearest_{}_{}", model.predicates[p].name,
                                     model.targets[model.distances[d].target].name));
    for (const plan::Let& let : plan.lets)
        for (const char* prefix : {"let_", "robustness_"})
            names.insert(prefix + model.lets[let.index].name);
    return names;
}

}  // namespace etlc::emit
