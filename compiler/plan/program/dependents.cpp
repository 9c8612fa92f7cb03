#include "plan/program/dependents.hpp"

namespace etlc::plan {

namespace {

class Walk {
public:
    Walk(const Plan& plan, std::size_t monitor, Dependents& result)
        : plan_(plan), monitor_(monitor), result_(result) {}

    void stream(Slot slot) {
        if (!add(result_.of_stream[slot])) return;
        for (Slot operand : plan_.streams[slot].operands) stream(operand);
    }

    void reading(std::uint32_t index) {
        if (!add(result_.of_reading[index])) return;
        const Reading& found = plan_.readings[index];
        for (std::uint32_t operand : found.operands) reading(operand);
        for_each_slot(found, [&](Slot slot) { stream(slot); });
    }

private:
    bool add(std::vector<std::size_t>& monitors) const {
        const bool is_new = monitors.empty() || monitors.back() != monitor_;
        if (is_new) monitors.push_back(monitor_);
        return is_new;
    }

    const Plan& plan_;
    std::size_t monitor_;
    Dependents& result_;
};

}  // namespace

Dependents dependents(const Plan& plan) {
    Dependents result{std::vector<std::vector<std::size_t>>(plan.streams.size()),
                      std::vector<std::vector<std::size_t>>(plan.readings.size())};
    for (std::size_t m = 0; m < plan.monitors.size(); ++m) {
        Walk walk(plan, m, result);
        plan.monitors[m].sliding ? walk.stream(plan.monitors[m].stream)
                                 : walk.reading(plan.monitors[m].reading);
    }
    for (std::size_t l = 0; l < plan.lets.size(); ++l)
        Walk(plan, plan.monitors.size() + l, result).stream(plan.lets[l].stream);
    return result;
}

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
