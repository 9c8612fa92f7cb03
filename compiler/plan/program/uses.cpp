#include "plan/program/uses.hpp"

namespace etlc::plan {

std::map<Index, int> scalar_uses(const Plan& plan) {
    const check::Model& model = *plan.model;
    std::map<Index, int> uses;
    const auto count = [&](const check::Expr& e) {
        if (e.kind == check::Expr::Kind::scalar) ++uses[e.index];
    };
    for (const Index p : plan.predicates)
        check::for_each_of_step(model.predicates[p].expression, count);
    for (const Index p : plan.pasts) check::for_each_of_step(model.pasts[p].expression, count);
    for (const Index d : plan.distances)
        for (const Index point : {model.distances[d].point, model.distances[d].other})
            if (point != check::kNone)
                for (const Index i : model.points[point].inputs) uses[i] += 2;
    return uses;
}

std::map<Index, int> distance_uses(const Plan& plan) {
    std::map<Index, int> uses;
    for (const Index p : plan.predicates) {
        const check::Predicate& predicate = plan.model->predicates[p];
        const int weight = predicate.plain_distance() ? 1 : 2;
        check::for_each_distance(predicate.expression, [&](Index d) { uses[d] += weight; });
    }
    return uses;
}

}  // namespace etlc::plan
