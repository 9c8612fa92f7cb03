#include "emit/measure/uses.hpp"

namespace etlc::emit {

using check::Index;

std::map<Index, int> distance_uses(const plan::Plan& plan) {
    std::map<Index, int> uses;
    for (Index p : plan.predicates) {
        const check::Predicate& predicate = plan.model->predicates[p];
        const int weight = predicate.plain_distance() ? 1 : 2;
        check::for_each_distance(predicate.expression, [&](Index d) { uses[d] += weight; });
    }
    return uses;
}

}  // namespace etlc::emit
