// Checks properties of the definitions on the reference, with random specs and traces: the bounds
// are sound, gaps cover every way of filling them, and negation mirrors all four numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "check/formulas/horizons.hpp"
#include "exhaustive.hpp"
#include "loading.hpp"
#include "random.hpp"
#include "random_spec.hpp"
#include "random_trace.hpp"
#include "reference/reference.hpp"

namespace {

using namespace etlc;
using namespace etlc::tests;
using reference::evaluate;
using reference::Trace;
using reference::Verdict;
using Formulas = SpecShape::Formulas;

constexpr int kSpecs = 60;
constexpr std::size_t kSteps = 10;

SpecShape shape_of(int n, Formulas formulas) {
    SpecShape shape;
    shape.formulas = formulas;
    shape.depth = 1 + n % 4;
    return shape;
}

/// Returns the trace's first `steps` steps, then others.
Trace continued(const Trace& trace, std::size_t steps, const Trace& other) {
    Trace result(trace.begin(), trace.begin() + static_cast<std::ptrdiff_t>(steps));
    result.insert(result.end(), other.begin(), other.end());
    return result;
}

/// Continues a trace after every third step by samples of that shape.
void expect_bounds_of_continuations(const check::Model& model, const Trace& trace,
                                    const TraceShape& shape, std::uint64_t seed) {
    const auto run = evaluate(model, trace);
    for (std::size_t i = 0; i < trace.size(); i += 3) {
        const auto other =
            evaluate(model, continued(trace, i + 1, random_trace(model, seed + i, shape)));
        for (std::size_t later = i; later < other.verdicts.size(); ++later)
            for (std::size_t m = 0; m < model.monitors.size(); ++m) {
                if (model.monitors[m].sliding) continue;
                const Verdict& now = run.verdicts[i][m];
                const Verdict& then = other.verdicts[later][m];
                ASSERT_LE(now.lower, then.robustness)
                    << model.file.text() << i << ", " << later << ": m" << m;
                ASSERT_GE(now.upper, then.robustness_high)
                    << model.file.text() << i << ", " << later << ": m" << m;
            }
    }
}

TEST(ReferenceProperties, BoundsHoldForEveryContinuation) {
    for (int n = 0; n < kSpecs; ++n) {
        const auto model = load(random_spec(1000 + n, shape_of(n, Formulas::prefix)));
        ASSERT_TRUE(model);
        TraceShape shape{
            .steps = kSteps, .missing = n % 2 == 0 ? 0 : 0.15, .invalid = n % 3 == 0 ? 0.05 : 0};
        const Trace trace = random_trace(*model, n, shape);
        shape.steps = 6;
        expect_bounds_of_continuations(*model, trace, shape, 77 * n);
        if (HasFatalFailure()) return;
    }
}

TEST(ReferenceProperties, BoundsOfEarlierStepsHoldForEveryContinuation) {
    for (const bool points : {false, true})
        for (const std::size_t inputs : {1, 2}) {
            const auto model =
                load(exhaustive_past_spec("earlier", {.points = points, .inputs = inputs}));
            ASSERT_TRUE(model);
            for (int n = 0; n < kSpecs; ++n) {
                const Trace trace =
                    random_trace(*model, n, {.steps = kSteps, .missing = n % 2 == 0 ? 0 : 0.15});
                const TraceShape extreme{.steps = 6, .extreme = n % 3 == 0 ? 0.9 : 0.3};
                expect_bounds_of_continuations(*model, trace, extreme, 77 * n);
                if (HasFatalFailure()) return;
            }
        }
}

/// Fills the gaps with random valid samples; `hold` must be off for the filled trace to contain the
/// hidden samples.
Trace filled(const check::Model& model, const Trace& trace, std::uint64_t seed) {
    Trace result = trace;
    const Trace other = random_trace(model, seed, {.steps = trace.size()});
    for (std::size_t n = 0; n < trace.size(); ++n)
        for (std::size_t input = 0; input < trace[n].size(); ++input)
            if (trace[n][input].empty()) result[n][input] = other[n][input];
    return result;
}

TEST(ReferenceProperties, UnknownCoversEveryFilling) {
    for (int n = 0; n < kSpecs; ++n) {
        auto model = load(
            random_spec(2000 + n, shape_of(n, n % 2 == 0 ? Formulas::prefix : Formulas::sliding)));
        ASSERT_TRUE(model);
        for (check::Input& input : model->inputs) input.hold = input.stale_after = 0;
        const Trace trace = random_trace(*model, n, {.steps = kSteps, .missing = 0.2});
        const auto gapped = evaluate(*model, trace);
        for (int filling = 0; filling < 3; ++filling) {
            const auto full = evaluate(*model, filled(*model, trace, 31 * n + filling));
            for (std::size_t i = 0; i < kSteps; ++i)
                for (std::size_t m = 0; m < model->monitors.size(); ++m) {
                    const Verdict& known = gapped.verdicts[i][m];
                    const Verdict& actual = full.verdicts[i][m];
                    ASSERT_LE(known.robustness, actual.robustness)
                        << model->file.text() << i << ": m" << m;
                    ASSERT_GE(known.robustness_high, actual.robustness)
                        << model->file.text() << i << ": m" << m;
                    ASSERT_LE(known.lower, actual.lower) << model->file.text() << i << ": m" << m;
                    ASSERT_GE(known.upper, actual.upper) << model->file.text() << i << ": m" << m;
                    ASSERT_LE(known.lower, known.robustness);
                    ASSERT_GE(known.upper, known.robustness_high);
                }
        }
    }
}

/// Returns a copy of the model in which every monitor is negated.
check::Model negated(check::Model model) {
    for (check::Monitor& monitor : model.monitors) {
        check::Formula negation;
        negation.kind = check::Formula::Kind::negation;
        negation.operands = {monitor.formula};
        model.formulas.push_back(negation);
        monitor.formula = static_cast<check::Index>(model.formulas.size() - 1);
    }
    return model;
}

void expect_mirrored(const std::vector<std::vector<Verdict>>& rows,
                     const std::vector<std::vector<Verdict>>& mirror) {
    ASSERT_EQ(rows.size(), mirror.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t m = 0; m < rows[i].size(); ++m) {
            if (rows[i][m].status == reference::Status::undecided) continue;
            ASSERT_EQ(rows[i][m].robustness, -mirror[i][m].robustness_high);
            ASSERT_EQ(rows[i][m].robustness_high, -mirror[i][m].robustness);
            ASSERT_EQ(rows[i][m].lower, -mirror[i][m].upper);
            ASSERT_EQ(rows[i][m].upper, -mirror[i][m].lower);
        }
}

TEST(ReferenceProperties, NegationMirrors) {
    for (int n = 0; n < kSpecs; ++n) {
        const auto model = load(
            random_spec(3000 + n, shape_of(n, n % 2 == 0 ? Formulas::prefix : Formulas::sliding)));
        ASSERT_TRUE(model);
        const Trace trace =
            random_trace(*model, n, {.steps = kSteps, .missing = 0.1, .invalid = 0.1});
        const auto run = evaluate(*model, trace);
        const auto mirror = evaluate(negated(*model), trace);
        SCOPED_TRACE(std::string(model->file.text()) + to_csv(*model, trace));
        expect_mirrored(run.verdicts, mirror.verdicts);
        expect_mirrored(run.finish, mirror.finish);
        EXPECT_EQ(run.missing_steps, mirror.missing_steps);
        if (HasFatalFailure()) return;
    }
}

TEST(ReferenceProperties, RangesHoldWhatIsMeasured) {
    for (int n = 0; n < kSpecs; ++n) {
        SpecShape spec_shape = shape_of(n, Formulas::unnested);
        spec_shape.exact = false;
        const auto model = load(random_spec(4000 + n, spec_shape));
        ASSERT_TRUE(model);
        const auto run =
            evaluate(*model, random_trace(*model, n, {.steps = 40, .grid = n % 2 == 0}));
        for (const auto& step : run.telemetry)
            for (std::size_t p = 0; p < model->predicates.size(); ++p) {
                const check::Predicate& predicate = model->predicates[p];
                const double delta = step[p].delta;
                const double epsilon = predicate.threshold.value;
                if (delta != delta) continue;
                ASSERT_LE(predicate.delta.low, delta) << model->file.text();
                ASSERT_GE(predicate.delta.high, delta) << model->file.text();
                const double infinity = std::numeric_limits<double>::infinity();
                const bool holds = check::holds(predicate.comparison, delta, epsilon);
                const double rho = predicate.equality()      ? (holds ? infinity : -infinity)
                                   : predicate.upper_bound() ? epsilon - delta
                                                             : delta - epsilon;
                ASSERT_LE(predicate.robustness.low, rho) << model->file.text();
                ASSERT_GE(predicate.robustness.high, rho) << model->file.text();
            }
    }
}

/// Whether step 0 alone may decide it, which the analysis of the past leaves out, or a robustness
/// of exactly 0, at which a formula and its negation are satisfied.
bool is_left_out(const check::Model& model, check::Index formula) {
    using Kind = check::Formula::Kind;
    const std::vector<check::Index> parts = check::parts_of(model, formula);
    return std::any_of(parts.begin(), parts.end(), [&](check::Index part) {
        const Kind kind = model.formulas[part].kind;
        return kind == Kind::until || kind == Kind::release || kind == Kind::weak_until ||
               kind == Kind::equivalence;
    });
}

// The warning of predicates that lack their past at first (W0507) holds on every trace.
TEST(ReferenceProperties, WithoutPastThereIsNoVerdict) {
    int unsatisfied = 0;
    int never_violated = 0;
    for (int n = 0; n < 4 * kSpecs; ++n) {
        const auto model = load(random_spec(5000 + n, shape_of(n, Formulas::prefix)));
        ASSERT_TRUE(model);
        const auto so_far = check::decidable(*model, check::Lasts::so_far, true);
        const auto for_good = check::decidable(*model, check::Lasts::for_good, true);
        const auto could_so_far = check::decidable(*model, check::Lasts::so_far, false);
        const auto could_for_good = check::decidable(*model, check::Lasts::for_good, false);
        for (int t = 0; t < 4; ++t) {
            const Trace trace = random_trace(*model, 10 * n + t, {.steps = 40, .grid = false});
            const auto run = evaluate(*model, trace);
            for (std::size_t m = 0; m < model->monitors.size(); ++m) {
                const check::Index formula = model->monitors[m].formula;
                if (is_left_out(*model, formula)) continue;
                const Verdict& last = run.verdicts.back()[m];
                if (so_far[formula].satisfied > 0 && could_so_far[formula].satisfied == 0) {
                    ++unsatisfied;
                    ASSERT_NE(last.status, reference::Status::satisfied)
                        << model->file.text() << "m" << m << "\n"
                        << to_csv(*model, trace);
                }
                if (for_good[formula].violated > 0 && could_for_good[formula].violated == 0) {
                    ++never_violated;
                    ASSERT_FALSE(last.final && last.status == reference::Status::violated)
                        << model->file.text() << "m" << m << "\n"
                        << to_csv(*model, trace);
                }
            }
        }
    }
    EXPECT_GT(unsatisfied, 50);
    EXPECT_GT(never_violated, 50);
}

TEST(RandomSpec, SameSeedSameText) {
    const SpecShape shape;
    EXPECT_EQ(random_spec(5, shape), random_spec(5, shape));
    EXPECT_NE(random_spec(5, shape), random_spec(6, shape));
}

}  // namespace
