// Tests the reference evaluator: distances, aggregations and expressions, on models made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "reference_models.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

double measured(Metric metric, std::vector<double> point, std::vector<float> target,
                check::Aggregation aggregation = check::Aggregation::min,
                std::vector<float> weights = {}, bool diagonal = false) {
    Spec spec;
    const auto dimension = static_cast<std::uint32_t>(point.size());
    const Index z = spec.input(InputType::f32, dimension);
    const Index t = spec.target(dimension, std::move(target));
    spec.monitor(
        spec.predicate(spec.distance({z}, t, metric, aggregation), Comparison::less_equal, 1));
    spec.model.distances[0].weights = std::move(weights);
    spec.model.distances[0].weights_diagonal = diagonal;
    spec.model.distances[0].kth = 2;
    return evaluate(spec.model, {{std::move(point)}}).telemetry[0][0].delta;
}

TEST(Reference, Metrics) {
    EXPECT_EQ(measured(Metric::l2, {3, 5}, {0, 1}), 5);
    EXPECT_EQ(measured(Metric::l2sq, {3, 5}, {0, 1}), 25);
    EXPECT_EQ(measured(Metric::l1, {3, 5}, {0, 1}), 7);
    EXPECT_EQ(measured(Metric::linf, {3, -5}, {0, 1}), 6);
    EXPECT_NEAR(measured(Metric::cosine, {1, 0}, {2, 2}), 1 - std::numbers::sqrt2 / 2, 1e-15);
    EXPECT_EQ(measured(Metric::cosine, {1, 0}, {-3, 0}), 2);
    EXPECT_NEAR(measured(Metric::angular, {1, 0}, {2, 2}), std::numbers::pi / 4, 1e-15);
    EXPECT_NEAR(measured(Metric::angular, {1, 0}, {-2, 0}), std::numbers::pi, 1e-15);
    EXPECT_EQ(measured(Metric::mahalanobis, {3, 2}, {0, 1}, check::Aggregation::min, {1, 7}, true),
              4);
    // d = (3, 1), W = [[2, 1], [1, 12]]: 18 + 3 + 3 + 12
    EXPECT_EQ(measured(Metric::mahalanobis, {3, 2}, {0, 1}, check::Aggregation::min, {2, 1, 1, 12}),
              6);
    EXPECT_TRUE(std::isnan(measured(Metric::cosine, {0, 0}, {1, 1})));
    EXPECT_TRUE(std::isnan(measured(Metric::angular, {0, 0}, {1, 1})));
    EXPECT_EQ(measured(Metric::l2, {0, 0}, {3, 4}), 5);
    EXPECT_TRUE(std::isnan(measured(Metric::l2, {0, kNan}, {3, 4})));
}

TEST(Reference, Aggregations) {
    const std::vector<float> targets{9, 1, 4, 2};
    using check::Aggregation;
    EXPECT_EQ(measured(Metric::l1, {0}, targets, Aggregation::min), 1);
    EXPECT_EQ(measured(Metric::l1, {0}, targets, Aggregation::max), 9);
    EXPECT_EQ(measured(Metric::l1, {0}, targets, Aggregation::mean), 4);
    EXPECT_EQ(measured(Metric::l1, {0}, targets, Aggregation::kth), 2);
}

TEST(Reference, NearestRowAndVectorOfScalars) {
    Spec spec;
    const Index x = spec.input();
    const Index y = spec.input();
    const Index t = spec.target(2, {9, 9, 1, 2, 1, 2});
    spec.monitor(spec.predicate(spec.distance({y, x}, t, Metric::l1), Comparison::greater, 1),
                 true);
    auto trace = scalars({2, 2}, {1, 1});
    trace[1][0] = kMissing;
    const auto run = evaluate(spec.model, trace);
    EXPECT_EQ(run.telemetry[0][0].delta, 0);  // the point is (y, x) = (1, 2)
    EXPECT_EQ(run.telemetry[0][0].nearest, 1U);
    EXPECT_EQ(run.verdicts[0][0].robustness, -1);
    EXPECT_EQ(run.verdicts[1][0].status, Status::unknown);
}

TEST(Reference, Expressions) {
    Spec spec;
    const Index x = spec.input();
    const Index y = spec.input();
    const auto term = [&](Expr::Kind kind, std::vector<Expr> arguments) {
        spec.monitor(
            spec.predicate(Spec::apply(kind, std::move(arguments)), Comparison::greater_equal, 0),
            true);
    };
    const Expr a = Spec::scalar(x);
    const Expr b = Spec::scalar(y);
    for (const auto kind : {Expr::Kind::add, Expr::Kind::subtract, Expr::Kind::multiply,
                            Expr::Kind::divide, Expr::Kind::min, Expr::Kind::max})
        term(kind, {a, b});
    for (const auto kind : {Expr::Kind::negate, Expr::Kind::abs, Expr::Kind::sqrt}) term(kind, {a});
    // NaN is unknown through min and max, on either side.
    term(Expr::Kind::min, {Spec::apply(Expr::Kind::sqrt, {b}), Spec::number(1)});
    term(Expr::Kind::max, {Spec::number(1), Spec::apply(Expr::Kind::divide, {b, b})});
    const auto run = evaluate(spec.model, scalars({4, 0}, {-2, 0}));
    const List expected{2, 6, -8, -2, -2, 4, -4, 4, 2};
    for (std::size_t n = 0; n < expected.size(); ++n)
        EXPECT_EQ(run.verdicts[0][n].robustness, expected[n]) << n;
    EXPECT_EQ(run.verdicts[0][9].status, Status::unknown);   // sqrt(-2)
    EXPECT_EQ(run.verdicts[1][3].status, Status::unknown);   // 0 / 0
    EXPECT_EQ(run.verdicts[1][10].status, Status::unknown);  // max(1, 0 / 0)
    EXPECT_EQ(run.missing_steps, 2U);
}

TEST(Reference, ComparisonsAndFloatNarrowing) {
    Spec spec;
    const Index x = spec.ranged(0, 0.1F);
    for (const auto comparison :
         {Comparison::less_equal, Comparison::less, Comparison::greater_equal, Comparison::greater})
        spec.monitor(spec.predicate(Spec::scalar(x), comparison, 0.1F), true);
    // 0.1 in double is below float32's 0.1; both are narrowed first, so it is in range and exactly
    // at the threshold.
    const auto run = evaluate(spec.model, scalars({0.1, 0.025}));
    for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(run.verdicts[0][n].robustness, 0);
    for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(run.verdicts[0][n].status, Status::satisfied);
    const double margin = static_cast<double>(0.1F) - static_cast<double>(0.025F);
    EXPECT_EQ(run.verdicts[1][0].robustness, margin);
    EXPECT_EQ(run.verdicts[1][3].robustness, -margin);
}

}  // namespace
