// Models and traces made by hand, for tests of the reference.
// Takes: pieces. Gives: a typed spec without parser or checker. Keeps true: operands come before
// their users.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "reference/reference.hpp"

namespace etlc::tests {

using check::Comparison;
using check::Expr;
using check::Formula;
using check::Index;
using check::InputType;
using check::Metric;
using reference::evaluate;
using reference::Status;
using List = std::vector<double>;
using Kind = Formula::Kind;

inline constexpr double kInf = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline const std::vector<double> kMissing{};

/// Builds a model piece by piece.
struct Spec {
    check::Model model;

    Index input(InputType type = InputType::scalar, std::uint32_t dimension = 1) {
        check::Input input;
        input.type = type;
        input.dimension = dimension;
        model.inputs.push_back(input);
        return static_cast<Index>(model.inputs.size() - 1);
    }

    Index ranged(float low, float high) {
        const Index x = input();
        model.inputs[x].range = {low, high};
        model.inputs[x].has_range = true;
        return x;
    }

    Index target(std::uint32_t dimension, std::vector<float> values) {
        check::Target target;
        target.dimension = dimension;
        target.rows = static_cast<std::uint32_t>(values.size()) / dimension;
        target.values = std::move(values);
        model.targets.push_back(target);
        return static_cast<Index>(model.targets.size() - 1);
    }

    Index point(std::vector<Index> inputs) {
        check::Point point;
        const bool scalars = model.inputs[inputs[0]].type == InputType::scalar;
        point.kind = scalars ? check::Point::Kind::scalars : check::Point::Kind::embedding;
        point.dimension =
            scalars ? static_cast<std::uint32_t>(inputs.size()) : model.inputs[inputs[0]].dimension;
        point.inputs = std::move(inputs);
        model.points.push_back(std::move(point));
        return static_cast<Index>(model.points.size() - 1);
    }

    Expr distance(std::vector<Index> point, Index target, Metric metric,
                  check::Aggregation aggregation = check::Aggregation::min) {
        check::Distance distance;
        distance.point = this->point(std::move(point));
        distance.target = target;
        distance.metric = metric;
        distance.aggregation = aggregation;
        model.distances.push_back(distance);
        return leaf(Expr::Kind::distance, static_cast<Index>(model.distances.size() - 1));
    }

    static Expr leaf(Expr::Kind kind, Index index, float number = 0) {
        Expr expr;
        expr.kind = kind;
        expr.index = index;
        expr.number32 = number;
        return expr;
    }
    static Expr scalar(Index input) { return leaf(Expr::Kind::scalar, input); }
    static Expr number(float value) { return leaf(Expr::Kind::number, 0, value); }
    static Expr apply(Expr::Kind kind, std::vector<Expr> arguments) {
        Expr expr;
        expr.kind = kind;
        expr.arguments = std::move(arguments);
        return expr;
    }

    /// Adds the predicate as a formula; `range` is that of its robustness.
    Index predicate(Expr expression, Comparison comparison, float epsilon,
                    check::Range range = {}) {
        check::Predicate predicate;
        predicate.expression = std::move(expression);
        predicate.comparison = comparison;
        predicate.threshold.value = epsilon;
        predicate.robustness = range;
        model.predicates.push_back(predicate);
        const Index formula = f(Kind::predicate, {});
        model.formulas[formula].index = static_cast<Index>(model.predicates.size() - 1);
        return formula;
    }

    /// Adds x >= 0 for a new scalar in [-8, 8]: its robustness is the sample itself.
    Index sample() {
        return predicate(scalar(ranged(-8, 8)), Comparison::greater_equal, 0, {-8, 8});
    }

    Index boolean() {
        const Index formula = f(Kind::boolean_input, {});
        model.formulas[formula].index = input(InputType::boolean);
        return formula;
    }

    Index f(Kind kind, std::vector<Index> operands, std::uint32_t low = 0,
            std::uint32_t high = check::kUnbounded) {
        Formula formula;
        formula.kind = kind;
        formula.operands = std::move(operands);
        formula.low = low;
        formula.high = high;
        if (check::looks_one_step_away(kind)) formula.low = formula.high = 1;
        model.formulas.push_back(formula);
        return static_cast<Index>(model.formulas.size() - 1);
    }

    void monitor(Index formula, bool sliding = false) {
        check::Monitor monitor;
        monitor.formula = formula;
        monitor.sliding = sliding;
        model.monitors.push_back(monitor);
    }
};

inline reference::Trace scalars(const std::vector<double>& x) {
    reference::Trace trace;
    for (const double value : x) trace.push_back({{value}});
    return trace;
}

inline reference::Trace scalars(const std::vector<double>& x, const std::vector<double>& y) {
    reference::Trace trace;
    for (std::size_t n = 0; n < x.size(); ++n) trace.push_back({{x[n]}, {y[n]}});
    return trace;
}

inline std::vector<double> robustness(const reference::Run& run, std::size_t monitor = 0) {
    std::vector<double> result;
    for (const auto& step : run.verdicts) result.push_back(step[monitor].robustness);
    return result;
}

/// Returns the verdicts of one prefix monitor over samples p; `make` builds its formula from p.
template <class Make>
std::vector<double> over(const std::vector<double>& p, Make make) {
    Spec spec;
    spec.monitor(make(spec, spec.sample()));
    return robustness(evaluate(spec.model, scalars(p)));
}

template <class Make>
std::vector<double> over(const std::vector<double>& p, const std::vector<double>& q, Make make) {
    Spec spec;
    const Index a = spec.sample();
    const Index b = spec.sample();
    spec.monitor(make(spec, a, b));
    return robustness(evaluate(spec.model, scalars(p, q)));
}

}  // namespace etlc::tests
