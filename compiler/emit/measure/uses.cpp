#include "emit/measure/uses.hpp"

namespace etlc::emit {

using check::Index;

std::map<Index, int> scalar_uses(const plan::Plan& plan) {
    const check::Model& model = *plan.model;
    std::map<Index, int> uses;
    for (Index p : plan.predicates)
        check::for_each(model.predicates[p].expression, [&](const check::Expr& e) {
            if (e.kind == check::Expr::Kind::scalar) ++uses[e.index];
        });
    for (Index d : plan.distances)
        for (const Index point : {model.distances[d].point, model.distances[d].other})
            if (point != check::kNone)
                for (Index i : model.points[point].inputs) uses[i] += 2;
    return uses;
}

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
