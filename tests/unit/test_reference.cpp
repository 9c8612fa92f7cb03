// Tests the reference evaluator: verdicts worked out by hand from docs/language.md, on models made
// by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference_models.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;

// Example 2 of the paper: epsilon = 0.409, distances 0.327, 0.374, 0.403, 0.427. (It prints -0.019
// where its own numbers give -0.018.)
TEST(Reference, PaperExample) {
    Spec spec;
    const Index z = spec.input(InputType::f32, 1);
    const Index goal = spec.target(1, {0});
    const Index near = spec.predicate(spec.distance({z}, goal, Metric::l2), Comparison::less_equal,
                                      0.409F, {-INFINITY, 0.409F});
    spec.monitor(spec.f(Kind::always, {near}));
    spec.monitor(near, true);
    const auto run = evaluate(spec.model, scalars({0.327, 0.374, 0.403, 0.427}));
    const List expected{0.082, 0.035, 0.006, -0.018};
    for (std::size_t step = 0; step < 4; ++step) {
        EXPECT_NEAR(run.verdicts[step][0].robustness, expected[step], 1e-6);  // the running minimum
        EXPECT_NEAR(run.verdicts[step][1].robustness, expected[step], 1e-6);  // step by step
        EXPECT_EQ(run.verdicts[step][0].upper, run.verdicts[step][0].robustness);
        EXPECT_EQ(run.verdicts[step][0].final, step == 3);
        EXPECT_EQ(run.verdicts[step][0].status, step == 3 ? Status::violated : Status::satisfied);
    }
    EXPECT_NEAR(run.telemetry[3][0].delta, 0.427, 1e-6);
    EXPECT_EQ(run.missing_steps, 0U);
}

TEST(Reference, BooleanConnectives) {
    EXPECT_EQ(over({3}, [](Spec& s, Index p) { return s.f(Kind::negation, {p}); }), List{-3});
    EXPECT_EQ(over({3}, {-2},
                   [](Spec& s, Index p, Index q) {
                       return s.f(Kind::conjunction, {p, q});
                   }),
              List{-2});
    EXPECT_EQ(over({3}, {-2},
                   [](Spec& s, Index p, Index q) {
                       return s.f(Kind::disjunction, {p, q});
                   }),
              List{3});
    // !p || q = max(-3, -2)
    EXPECT_EQ(over({3}, {-2},
                   [](Spec& s, Index p, Index q) {
                       return s.f(Kind::implication, {p, q});
                   }),
              List{-2});
    // (!p || q) && (!q || p) = min(max(-3, -2), max(2, 3))
    EXPECT_EQ(over({3}, {-2},
                   [](Spec& s, Index p, Index q) {
                       return s.f(Kind::equivalence, {p, q});
                   }),
              List{-2});
    EXPECT_EQ(over({3}, {-2},
                   [](Spec& s, Index p, Index q) {
                       return s.f(Kind::negation, {s.f(Kind::equivalence, {p, q})});
                   }),
              List{2});
    EXPECT_EQ(over({3}, [](Spec& s, Index) { return s.f(Kind::constant_true, {}); }), List{kInf});
    EXPECT_EQ(over({3}, [](Spec& s, Index) { return s.f(Kind::constant_false, {}); }), List{-kInf});
}

TEST(Reference, EventuallyAndAlways) {
    const List p{1, -2, 3, 0};
    EXPECT_EQ(over(p, [](Spec& s, Index f) { return s.f(Kind::eventually, {f}); }),
              (List{1, 1, 3, 3}));
    EXPECT_EQ(over(p, [](Spec& s, Index f) { return s.f(Kind::always, {f}); }),
              (List{1, -2, -2, -2}));
    EXPECT_EQ(over(p, [](Spec& s, Index f) { return s.f(Kind::eventually, {f}, 1, 2); }),
              (List{-kInf, -2, 3, 3}));
    EXPECT_EQ(over(p, [](Spec& s, Index f) { return s.f(Kind::always, {f}, 2, 3); }),
              (List{kInf, kInf, 3, 0}));
    // X is false at the end of the prefix and !X true there
    EXPECT_EQ(over(p, [](Spec& s, Index f) { return s.f(Kind::next, {f}); }),
              (List{-kInf, -2, -2, -2}));
    EXPECT_EQ(over(p, [](Spec& s, Index f) { return s.f(Kind::negation, {s.f(Kind::next, {f})}); }),
              (List{kInf, 2, 2, 2}));
    // F G p and G F p equal p at the last step
    const auto nested = [](Kind outer, Kind inner) {
        return [=](Spec& s, Index f) { return s.f(outer, {s.f(inner, {f})}); };
    };
    EXPECT_EQ(over(p, nested(Kind::eventually, Kind::always)), p);
    EXPECT_EQ(over(p, nested(Kind::always, Kind::eventually)), p);
}

TEST(Reference, UntilReleaseWeakUntil) {
    const List p{4, 2, -1, 5};
    const List q{-3, 1, 3, 2};
    const auto binary = [](Kind kind, std::uint32_t low = 0,
                           std::uint32_t high = check::kUnbounded) {
        return [=](Spec& s, Index f, Index g) { return s.f(kind, {f, g}, low, high); };
    };
    // j=0: -3; j=1: min(1, 4); j=2: min(3, 4, 2); j=3: min(2, 4, 2, -1)
    EXPECT_EQ(over(p, q, binary(Kind::until)), (List{-3, 1, 2, 2}));
    EXPECT_EQ(over(p, q, binary(Kind::until, 1, 1)), (List{-kInf, 1, 1, 1}));
    // j=0: -3; j=1: max(1, 4); j=2: max(3, 4, 2); j=3: max(2, 4, ...)
    EXPECT_EQ(over(p, q, binary(Kind::release)), (List{-3, -3, -3, -3}));
    EXPECT_EQ(over(p, q, binary(Kind::release, 1, 3)), (List{kInf, 4, 4, 4}));
    // q R (p || q): j=0: max(4, -3); j=1: max(2, 1 | -3) = 2; j=2: max(3, 1); j=3: max(5, ...)
    EXPECT_EQ(over(p, q, binary(Kind::weak_until)), (List{4, 2, 2, 2}));
    // R is -rho(!f U !g)
    EXPECT_EQ(over(p, q,
                   [](Spec& s, Index f, Index g) {
                       const Index until = s.f(
                           Kind::until, {s.f(Kind::negation, {f}), s.f(Kind::negation, {g})}, 1, 3);
                       return s.f(Kind::negation, {until});
                   }),
              over(p, q, binary(Kind::release, 1, 3)));
    EXPECT_EQ(over(p, q,
                   [](Spec& s, Index f, Index g) {
                       return s.f(Kind::negation, {s.f(Kind::weak_until, {f, g})});
                   }),
              (List{-4, -2, -2, -2}));
}

/// Sliding monitors without a future report step by step, which shows past operators at every
/// position.
TEST(Reference, PastOperators) {
    const List p{1, -2, 3, 0};
    const List q{2, -1, -4, 1};
    const auto at_each = [&](Kind kind, bool binary, std::uint32_t low = 0,
                             std::uint32_t high = check::kUnbounded, bool negated = false,
                             bool each_step = false) {
        Spec spec;
        const Index a = spec.sample();
        const Index b = spec.sample();
        Index formula = spec.f(kind, binary ? std::vector{a, b} : std::vector{a}, low, high);
        if (kind == Kind::count) spec.model.formulas[formula].index = 2;
        spec.model.formulas[formula].each_step = each_step;
        if (negated) formula = spec.f(Kind::negation, {formula});
        spec.monitor(formula, true);
        return robustness(evaluate(spec.model, scalars(p, q)));
    };
    EXPECT_EQ(at_each(Kind::once, false), (List{1, 1, 3, 3}));
    EXPECT_EQ(at_each(Kind::historically, false), (List{1, -2, -2, -2}));
    EXPECT_EQ(at_each(Kind::once, false, 1, 2), (List{-kInf, 1, 1, 3}));
    EXPECT_EQ(at_each(Kind::historically, false, 2, 9), (List{kInf, kInf, 1, -2}));
    EXPECT_EQ(at_each(Kind::previous, false), (List{-kInf, 1, -2, 3}));
    EXPECT_EQ(at_each(Kind::rise, false), (List{-kInf, -2, 2, -3}));  // min(x, -x before)
    EXPECT_EQ(at_each(Kind::fall, false), (List{-kInf, 1, -3, 0}));   // min(-x, x before)
    EXPECT_EQ(at_each(Kind::fall, false, 0, 0, true), (List{kInf, -1, 3, 0}));
    // The second best of the rises -inf, -2, 2, -3 at the last three steps.
    EXPECT_EQ(at_each(Kind::count, false, 0, 2), (List{-kInf, -kInf, -2, -2}));
    EXPECT_EQ(at_each(Kind::count, false, 0, 2, true), (List{kInf, kInf, 2, 2}));
    // The second best of 1, -2, 3, 0 at the last three steps.
    EXPECT_EQ(at_each(Kind::count, false, 0, 2, false, true), (List{-kInf, -2, 1, 0}));
    EXPECT_EQ(at_each(Kind::count, false, 0, 2, true, true), (List{kInf, 2, -1, 0}));
    EXPECT_EQ(at_each(Kind::held, false, 0, 2), (List{-kInf, -kInf, -2, -2}));
    EXPECT_EQ(at_each(Kind::held, false, 0, 0), (List{1, -2, 3, 0}));
    EXPECT_EQ(at_each(Kind::held, false, 0, 1, true), (List{kInf, 2, 2, 0}));
    // k=1: max(min(2, -2), -1); k=2: max(min(2, -2, 3), min(-1, 3), -4); k=3: max(-2, min(-1, 3,
    // 0), min(-4, 0), 1)
    EXPECT_EQ(at_each(Kind::since, true), (List{2, -1, -1, 1}));
    EXPECT_EQ(at_each(Kind::since, true, 1, 1), (List{-kInf, -2, -1, -4}));
    EXPECT_EQ(at_each(Kind::since, true, 1, 1, true), (List{kInf, 2, 1, 4}));
}

TEST(Reference, BoundsOfFutureOperators) {
    Spec spec;
    const Index p = spec.sample();  // in [-8, 8]
    const Index q = spec.sample();
    spec.monitor(spec.f(Kind::eventually, {p}));
    spec.monitor(spec.f(Kind::eventually, {p}, 0, 1));
    spec.monitor(spec.f(Kind::always, {p}, 1, 2));
    spec.monitor(spec.f(Kind::until, {p, q}));
    spec.monitor(spec.f(Kind::release, {p, q}));
    spec.monitor(spec.f(Kind::next, {spec.f(Kind::eventually, {p}, 1, 1)}));
    const auto run = evaluate(spec.model, scalars({1, -2, 3}, {-5, -3, 2}));
    const auto bounds = [&](std::size_t step, std::size_t monitor) {
        const auto& v = run.verdicts[step][monitor];
        return List{v.lower, v.upper};
    };
    EXPECT_EQ(bounds(0, 0), (List{1, 8}));
    EXPECT_EQ(bounds(0, 1), (List{1, 8}));
    EXPECT_EQ(bounds(1, 1), (List{1, 1}));  // the window is full
    EXPECT_EQ(bounds(0, 2), (List{-8, kInf}));
    EXPECT_EQ(bounds(1, 2), (List{-8, -2}));
    EXPECT_EQ(bounds(2, 2), (List{-2, -2}));
    // until: p's least upper so far caps every later witness
    EXPECT_EQ(bounds(0, 3), (List{-5, 1}));
    EXPECT_EQ(bounds(1, 3), (List{-3, -2}));
    EXPECT_TRUE(run.verdicts[1][3].final);
    // release: min(q(0), max(q(1), p(0)), ...), later positions are at least max p = 1
    EXPECT_EQ(bounds(0, 4), (List{-5, -5}));
    // X F[1,1] p at 0: X reaches past 0, where F[1,1] may be empty or up to 8
    EXPECT_EQ(bounds(0, 5), (List{-kInf, 8}));
    EXPECT_EQ(bounds(1, 5), (List{-kInf, 8}));
    EXPECT_EQ(bounds(2, 5), (List{3, 3}));
}

TEST(Reference, BoundsOverPastOperators) {
    Spec spec;
    const Index p = spec.sample();
    const auto always = [&](Index f) { spec.monitor(spec.f(Kind::always, {f}, 1)); };
    const auto eventually = [&](Index f) { spec.monitor(spec.f(Kind::eventually, {f}, 1)); };
    always(spec.f(Kind::once, {p}));              // an unbounded O keeps past values
    eventually(spec.f(Kind::historically, {p}));  // and so does H
    always(spec.f(Kind::once, {p}, 0, 3));        // a bounded one forgets
    always(spec.f(Kind::previous, {p}));
    spec.monitor(
        spec.f(Kind::eventually, {spec.f(Kind::once, {spec.f(Kind::constant_false, {})})}, 1));
    const auto run = evaluate(spec.model, scalars({2, -3}));
    const auto bounds = [&](std::size_t step, std::size_t monitor) {
        const auto& v = run.verdicts[step][monitor];
        return List{v.lower, v.upper};
    };
    EXPECT_EQ(bounds(0, 0), (List{2, kInf}));
    EXPECT_TRUE(run.verdicts[0][0].final);
    EXPECT_EQ(bounds(1, 0), (List{2, 2}));
    EXPECT_EQ(bounds(0, 1), (List{-kInf, 2}));
    EXPECT_EQ(bounds(1, 1), (List{-3, -3}));
    EXPECT_EQ(bounds(0, 2), (List{-8, kInf}));
    EXPECT_EQ(bounds(0, 3), (List{-kInf, kInf}));
    EXPECT_EQ(bounds(0, 4), (List{-kInf, -kInf}));
}

TEST(Reference, MissingSamples) {
    Spec spec;
    const Index p = spec.sample();
    spec.monitor(spec.f(Kind::always, {p}));
    spec.monitor(spec.f(Kind::eventually, {spec.f(Kind::negation, {p})}));
    reference::Trace trace = scalars({1, 0, 9, kNan, -2, kInf, 2});
    trace[1][0] = kMissing;
    const auto run = evaluate(spec.model, trace);
    EXPECT_EQ(run.verdicts[0][0].status, Status::satisfied);
    for (std::size_t step = 1; step < 4;
         ++step) {  // missing, out of range, not a number: all unknown
        const auto& v = run.verdicts[step][0];
        EXPECT_EQ(v.status, Status::unknown);
        EXPECT_EQ(v.robustness, -8);
        EXPECT_EQ(v.robustness_high, 1);
        EXPECT_EQ(v.lower, -8);
        EXPECT_EQ(v.upper, 1);
        EXPECT_FALSE(v.final);
    }
    EXPECT_EQ(run.verdicts[4][0].status, Status::violated);
    EXPECT_TRUE(run.verdicts[4][0].final);
    EXPECT_EQ(run.verdicts[3][1].status, Status::unknown);
    EXPECT_EQ(run.verdicts[4][1].status, Status::satisfied);
    EXPECT_EQ(run.missing_steps, 4U);
    EXPECT_TRUE(std::isnan(run.telemetry[2][0].delta));
}

TEST(Reference, HoldStandsInForAtMostNSteps) {
    Spec spec;
    const Index p = spec.sample();
    spec.model.inputs[0].hold = 2;
    spec.monitor(p, true);
    // No sample to hold before the first one; 9 is out of range; the third missing one in a row is
    // missing.
    reference::Trace trace = scalars({0, 5, 9, 0, 0, 4, 0});
    trace[0][0] = trace[3][0] = trace[4][0] = trace[6][0] = kMissing;
    const auto run = evaluate(spec.model, trace);
    EXPECT_EQ(robustness(run), (List{-8, 5, 5, 5, -8, 4, 4}));
    EXPECT_EQ(run.verdicts[4][0].status, Status::unknown);
    EXPECT_EQ(run.missing_steps, 2U);
}

TEST(Reference, StaleSamplesAreMissing) {
    Spec spec;
    const Index p = spec.sample();
    spec.model.inputs[0].stale_after = 2;
    spec.monitor(p, true);
    // The third 5 in a row is stale. Neither the missing sample nor the 9, which is out of range,
    // ends the row; another sample does, and 0 is another than -0.
    reference::Trace trace = scalars({5, 5, 5, 0, 9, 5, 4, 5, 0, -0.0, 0, 0, 0});
    trace[3][0] = kMissing;
    const auto run = evaluate(spec.model, trace);
    EXPECT_EQ(robustness(run), (List{5, 5, -8, -8, -8, -8, 4, 5, 0, 0, 0, 0, -8}));
    EXPECT_EQ(run.verdicts[2][0].status, Status::unknown);
    EXPECT_EQ(run.missing_steps, 5U);
}

TEST(Reference, HoldReplacesStaleSamples) {
    Spec spec;
    const Index p = spec.sample();
    spec.model.inputs[0].stale_after = 1;
    spec.model.inputs[0].hold = 2;
    spec.monitor(p, true);
    EXPECT_EQ(robustness(evaluate(spec.model, scalars({5, 5, 5, 5, 4, 5}))),
              (List{5, 5, 5, -8, 4, 5}));
}

TEST(Reference, MissingStepsCountOnlyWhatMonitorsDependOn) {
    Spec spec;
    const Index p = spec.sample();
    const Index other = spec.sample();
    spec.monitor(p);
    reference::Trace trace = scalars({1, 1}, {1, 1});
    trace[1][1] = kMissing;
    EXPECT_EQ(evaluate(spec.model, trace).missing_steps, 0U);
    spec.monitor(other);
    EXPECT_EQ(evaluate(spec.model, trace).missing_steps, 1U);
}

TEST(Reference, BooleanInput) {
    Spec spec;
    spec.monitor(spec.f(Kind::always, {spec.boolean()}));
    auto trace = scalars({1, 0, 1});
    trace[1][0] = kMissing;
    const auto run = evaluate(spec.model, trace);
    EXPECT_EQ(robustness(run), (List{kInf, -kInf, -kInf}));
    EXPECT_EQ(run.verdicts[0][0].lower, -kInf);
    EXPECT_EQ(run.verdicts[2][0].status, Status::unknown);
    EXPECT_EQ(run.verdicts[2][0].upper, kInf);
}

TEST(Reference, SlidingVerdictsAndFinish) {
    Spec spec;
    const Index p = spec.sample();
    spec.monitor(spec.f(Kind::always, {p}, 0, 2), true);  // horizon 2
    spec.monitor(spec.f(Kind::next, {spec.f(Kind::next, {spec.f(Kind::next, {p})})}),
                 true);  // horizon 3
    spec.monitor(spec.f(Kind::eventually, {p}));
    spec.monitor(spec.f(Kind::once, {spec.f(Kind::eventually, {p}, 0, 1)}, 0, 5),
                 true);  // past adds nothing: 1
    const auto run = evaluate(spec.model, scalars({3, 1, 2, -1}));
    const auto column = [&](std::size_t monitor) {
        List result;
        for (const auto& step : run.verdicts)
            result.push_back(step[monitor].status == Status::undecided ? kNan
                                                                       : step[monitor].robustness);
        for (const auto& call : run.finish)
            result.push_back(call[monitor].status == Status::undecided ? kNan
                                                                       : call[monitor].robustness);
        return result;
    };
    const auto expect = [&](std::size_t monitor, const List& wanted) {
        const List got = column(monitor);
        ASSERT_EQ(got.size(), wanted.size());
        for (std::size_t n = 0; n < got.size(); ++n)
            EXPECT_TRUE(got[n] == wanted[n] || (std::isnan(got[n]) && std::isnan(wanted[n])))
                << monitor << ' ' << n;
    };
    ASSERT_EQ(run.finish.size(), 3U);
    expect(0, {kNan, kNan, 1, -1, -1, -1, kNan});
    expect(1, {kNan, kNan, kNan, -1, -kInf, -kInf, -kInf});
    expect(2, {3, 3, 3, 3, 3, 3, 3});
    expect(3, {kNan, 3, 3, 3, 3, kNan, kNan});
    EXPECT_FALSE(run.verdicts[0][0].final);
    EXPECT_TRUE(run.verdicts[2][0].final);
    EXPECT_TRUE(run.finish[0][0].final);
}

TEST(Reference, FinishOfATraceShorterThanTheHorizon) {
    Spec spec;
    spec.monitor(spec.f(Kind::eventually, {spec.sample()}, 0, 3), true);
    const auto run = evaluate(spec.model, scalars({-1, 2}));
    ASSERT_EQ(run.finish.size(), 3U);  // positions -1, 0 and 1
    EXPECT_EQ(run.finish[0][0].status, Status::undecided);
    EXPECT_EQ(run.finish[1][0].robustness, 2);
    EXPECT_EQ(run.finish[2][0].robustness, 2);
    EXPECT_TRUE(evaluate(spec.model, {}).finish.empty());
}

}  // namespace
