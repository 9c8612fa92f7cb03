// Checks that compiled monitors keep the guarantees: -O0, -O3 -march=native -ffast-math and AArch64
// measure within the interval that calibration assumes, and a covered demonstration is covered
// there too, including ties and <. Common builds measure the same bits as etlc.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calibrate/bounds.hpp"
#include "check/guarantees/conformal.hpp"
#include "check/points/points.hpp"
#include "execute/evaluator.hpp"
#include "generated_program.hpp"
#include "ir/lower.hpp"
#include "loading.hpp"
#include "plan/plan.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

using calibrate::Index;
using calibrate::Interval;

constexpr int kDimension = 24;
constexpr int kDraws = 2000;
constexpr int kDemonstrations = 9;  // the fewest for alpha = 0.1: the threshold is the greatest
                                    // score
constexpr int kFrames = 2;
constexpr std::size_t kSteps = 500;  // of an episode: the harness needs traces of equal length

std::string matrix(Random& random, int rows, int columns) {
    std::string text = "[";
    for (int r = 0; r < rows; ++r) {
        text += r == 0 ? "[" : ", [";
        for (int c = 0; c < columns; ++c)
            text += fmt::format("{}{}", c == 0 ? "" : ", ", random.grid(-1, 1, 0.125));
        text += "]";
    }
    return text + "]";
}

std::string spec_text() {
    Random random(6);
    std::string weights;
    for (int i = 0; i < kDimension; ++i)
        weights += fmt::format("{}{}", i == 0 ? "" : ", ", random.grid(0.25, 4, 0.25));
    const std::vector<std::string> predicates = {
        "min l2(z, g) <= 1",
        "min cosine(z, g) < 1",
        "mean l1(z, g) >= 1",
        "kth(2) linf(z, g) < 1",
        "max angular(z, g) > 1",
        "min l2sq(z, g) <= 1",
        fmt::format("mean mahalanobis([{}])(z, g) <= 1", weights),
        "min mahalanobis([[2, 1.5, 0], [1.5, 2, 0.5], [0, 0.5, 1]])(v, h) <= 1",
        "kth(2) mahalanobis([[100, 99, 0], [99, 100, 0], [0, 0, 1]])(v, h) > 1",
        "mean cosine(z, g) >= 1",
        "min cosine(z, g) - 0.5 * min l2(z, g) / (1 + s * s) <= 1",
        "sqrt(abs(s) + min l1(z, g)) > 1",
        "max(s * 3.1, min l2(v, h)) < 1",
        "s + 0.1 >= 1",
        "min l2(P(z), g) <= 1",
        "mean l1(P(z), g) <= 1",
        "min cosine(P(z), g) <= 1",
        "max angular(Q(P(z)), g) > 1",
        "kth(2) linf(Q(P(z)), g) < 1",
        "min l2sq(Q(v), h) <= 1",
        "min mahalanobis([[2, 1.5, 0], [1.5, 2, 0.5], [0, 0.5, 1]])(P(z), g) <= 1",
        "min l2(P(z), g) - min l2(Q(v), h) <= 0.5",
        "mean(min l2(P(z), g), 5 steps) <= 1",
        "max(min cosine(z, g), 4 steps) - min(s * 3.1, 3 steps)@2 <= 1",
        "mean(mean(s, 3 steps) - min l1(z, g)@1, 2 steps) > 0",
        "l2(z, z@2) <= 1",
        "cosine(z, z@1) <= 1",
        "angular(v@3, v) > 1",
        "min l2(P(z@2), g) <= 1",
        "min cosine(P(z)@1, g) < 1",
        "mean l1(Q(P(z@1)@2), g) <= 1",
        "l1(P(z), P(z)@3) <= 1",
        "cosine(P(z), P(z)@2) <= 1",
        "mahalanobis([[2, 1.5, 0], [1.5, 2, 0.5], [0, 0.5, 1]])(P(z), P(z@1)) <= 1",
        "linf([v, P(z)], [v@1, P(z@2)]@1) <= 1",
        "max(l2(P(z), P(z@1)), 4 steps) - l2sq([s, v], [s@2, v@1]) <= 1",
    };
    std::string text = fmt::format(
        "spec deployed; input z : f32[{}]; input v : f32[3]; input s : f32;\n", kDimension);
    text += fmt::format("projection P = {} offset {}; projection Q = {};\n",
                        matrix(random, 3, kDimension), matrix(random, 1, kDimension),
                        matrix(random, 3, 3));
    text += fmt::format("target g = {}; target h = {};\n", matrix(random, 5, kDimension),
                        matrix(random, 3, 3));
    for (std::size_t i = 0; i < predicates.size(); ++i)
        text += fmt::format("predicate p{0} = {1}; monitor m{0} = F p{0};\n", i, predicates[i]);
    return text;
}

/// Ordinary points; points on a grid, whose distances tie; points at a target or one rounding away
/// from it.
reference::Step random_step(Random& random, const check::Model& model) {
    reference::Step step;
    const int kind = random.between(0, 3);
    for (std::size_t i = 0; i < 2; ++i) {
        const check::Target& target = model.targets[i];
        const int row = random.between(0, static_cast<int>(target.rows) - 1);
        std::vector<double> point;
        for (std::uint32_t d = 0; d < target.dimension; ++d) {
            const auto g = static_cast<double>(
                target.values[static_cast<std::uint32_t>(row) * target.dimension + d]);
            if (kind == 0) point.push_back(g + (random.chance(0.2) ? random.grid(-1, 1, 0.5) : 0));
            if (kind == 1)
                point.push_back(
                    static_cast<double>(static_cast<float>(g + 1e-7 * (random.uniform() - 0.5))));
            if (kind >= 2)
                point.push_back(static_cast<double>(static_cast<float>(2 * random.uniform() - 1)));
        }
        step.push_back(std::move(point));
    }
    step.push_back({kind == 0 ? random.grid(-1, 1, 0.25)
                              : static_cast<double>(static_cast<float>(random.uniform()))});
    return step;
}

struct Deployed : testing::Test {
    check::Model model = *load(spec_text());
    reference::Trace trace;
    std::vector<std::vector<Interval>> intervals;                  ///< [frame][predicate]
    std::vector<std::vector<float>> measured;                      ///< measured by etlc
    std::map<std::string, std::vector<std::vector<float>>> built;  ///< by name

    void measure() {
        Random random(99);
        for (int i = 0; i < kDraws * (kDemonstrations + 1) * kFrames; ++i)
            trace.push_back(random_step(random, model));
        std::vector<Index> predicates(model.predicates.size());
        for (Index i = 0; i < predicates.size(); ++i) predicates[i] = i;
        const plan::Plan plan = plan::measuring(model, predicates);
        execute::Evaluator evaluator(plan);
        calibrate::PastIntervals pasts(model, plan);
        for (std::size_t i = 0; i < trace.size(); ++i) {
            if (i % kSteps == 0) evaluator.reset();
            if (i % kSteps == 0) pasts.reset();
            std::vector<execute::Sample> samples;
            for (const auto& values : trace[i])
                samples.push_back({true, {values.begin(), values.end()}});
            evaluator.step(samples);
            pasts.step(evaluator);
            intervals.emplace_back();
            measured.emplace_back();
            for (const Index p : predicates) {
                intervals.back().push_back(
                    calibrate::interval_of(model, p, evaluator, pasts).value_or(Interval{0, 0}));
                measured.back().push_back(evaluator.distance(p));
            }
        }
    }

    /// Steps through the first frames.
    void build(const Build& build, std::size_t frames) {
        GeneratedProgram program("deployed" + build.name);
        ASSERT_TRUE(program.add(model));
        ASSERT_TRUE(program.compile(build));
        std::vector<Request> requests;
        for (std::size_t at = 0; at < frames; at += kSteps) {
            const auto first = trace.begin() + static_cast<std::ptrdiff_t>(at);
            const auto last =
                trace.begin() + static_cast<std::ptrdiff_t>(std::min(at + kSteps, frames));
            requests.push_back({0, {first, last}, {}});
        }
        auto& deltas = built[build.name];
        for (const Answer& answer : program.run(requests).answers)
            for (const auto& frame : answer[0].telemetry) {
                deltas.emplace_back();
                for (const auto& predicate : frame)
                    deltas.back().push_back(static_cast<float>(predicate.delta));
            }
        ASSERT_EQ(deltas.size(), frames);
    }

    /// Returns how many distances differ from etlc, and checks that all stay within the interval.
    std::size_t differing(const std::string& build) const {
        std::size_t result = 0;
        const std::vector<std::vector<float>>& deltas = built.at(build);
        for (std::size_t f = 0; f < deltas.size(); ++f)
            for (Index p = 0; p < model.predicates.size(); ++p) {
                const auto delta = static_cast<double>(deltas[f][p]);
                if (std::isnan(measured[f][p])) continue;
                result += deltas[f][p] != measured[f][p] ? 1 : 0;
                EXPECT_GE(delta, intervals[f][p].low) << build << " " << model.predicates[p].text;
                EXPECT_LE(delta, intervals[f][p].high) << build << " " << model.predicates[p].text;
                if (HasFailure()) return result;  // report one
            }
        return result;
    }
};

/// Returns whether frames depend on earlier ones, which leaves no exchangeable demonstrations.
bool looks_back(const check::Model& model, const check::Predicate& predicate) {
    bool found = false;
    check::for_each(predicate.expression, [&](const check::Expr& e) {
        found = found || e.kind == check::Expr::Kind::past;
        if (e.kind != check::Expr::Kind::distance) return;
        const check::Distance& distance = model.distances[e.index];
        found = found || check::longest_delay(model, distance.point) > 0 ||
                (distance.is_between_points() && check::longest_delay(model, distance.other) > 0);
    });
    return found;
}

/// The score of the demonstration for this predicate, at the farthest that another build may
/// measure.
double reach(const Deployed& of, Index predicate, std::size_t first_frame) {
    double worst = -INFINITY;
    for (std::size_t f = first_frame; f < first_frame + kFrames; ++f) {
        const Interval& interval = of.intervals[f][predicate];
        worst = std::max(
            worst, of.model.predicates[predicate].upper_bound() ? interval.high : -interval.low);
    }
    return worst;
}

TEST_F(Deployed, EveryBuildStaysWithinItsIntervalAndCovers) {
    measure();
    build({"Unoptimised", "g++", "-O0"}, trace.size());
    build({"Native", "g++", "-O3 -march=native -ffast-math"}, trace.size());
    std::size_t differ = 0;
    std::map<std::pair<std::string, Index>, int> covered;
    for (const auto& [name, deltas] : built) differ += differing(name);
    EXPECT_GT(differ, 1000U) << "else all measure what etlc measures, and nothing was tested";

    for (int draw = 0; draw < kDraws; ++draw) {
        const std::size_t begin = static_cast<std::size_t>(draw) * (kDemonstrations + 1) * kFrames;
        for (Index p = 0; p < model.predicates.size(); ++p) {
            if (looks_back(model, model.predicates[p])) continue;
            std::vector<double> reaches;
            for (int d = 0; d < kDemonstrations; ++d)
                reaches.push_back(reach(*this, p, begin + static_cast<std::size_t>(d) * kFrames));
            std::sort(reaches.begin(), reaches.end());
            const double kth = reaches[check::rank("0.1", kDemonstrations) - 1];
            const bool upper = model.predicates[p].upper_bound();
            const float epsilon = upper ? check::strictly_above(kth) : -check::strictly_above(kth);
            const std::size_t test = begin + std::size_t{kDemonstrations} * kFrames;
            const bool by_score = reach(*this, p, test) <= kth;
            for (const auto& [name, deltas] : built) {
                bool all = true;
                for (std::size_t f = test; f < test + kFrames; ++f)
                    all = all && (upper ? epsilon - deltas[f][p] : deltas[f][p] - epsilon) > 0;
                ASSERT_TRUE(all || !by_score) << name << " " << model.predicates[p].text;
                covered[{name, p}] += all ? 1 : 0;
            }
        }
    }
    // Three standard errors of a binomial proportion.
    const double least = 0.9 - 3 * std::sqrt(0.1 * 0.9 / kDraws);
    for (const auto& [which, count] : covered)
        EXPECT_GE(static_cast<double>(count) / kDraws, least)
            << which.first << " " << model.predicates[which.second].text;
}

/// The calibration of whole monitors asks for the intervals before the step is over.
TEST_F(Deployed, IntervalsWithinAStepAreThoseAfterIt) {
    measure();
    ir::Program program = ir::lower(model);
    diag::Sink sink;
    const auto plan = plan::plan(program, {}, sink, check::Values::robustness);
    ASSERT_TRUE(plan);
    execute::Evaluator evaluator(*plan);
    calibrate::PastIntervals pasts(model, *plan);
    std::size_t frame = 0;
    std::size_t compared = 0;
    evaluator.after_pasts([&] {
        pasts.step(evaluator);
        for (const Index p : plan->predicates) {
            const auto interval = calibrate::interval_of(model, p, evaluator, pasts);
            if (!interval) continue;
            EXPECT_EQ(interval->low, intervals[frame][p].low) << model.predicates[p].text;
            EXPECT_EQ(interval->high, intervals[frame][p].high) << model.predicates[p].text;
            ++compared;
        }
    });
    for (frame = 0; frame < kSteps && !HasFailure(); ++frame) {
        std::vector<execute::Sample> samples;
        for (const auto& values : trace[frame])
            samples.push_back({true, {values.begin(), values.end()}});
        evaluator.step(samples);
    }
    EXPECT_GT(compared, kSteps * model.predicates.size() - 100);
}

/// Whether it has its own kernels, projections included.
TEST_F(Deployed, AnotherMachineStaysWithinItsInterval) {
    measure();
    build(kAarch64, 4000);
    differing(kAarch64.name);
}

TEST_F(Deployed, CommonBuildsMeasureWhatEtlcMeasures) {
    measure();
#if defined(ETLMON_NO_DISPATCH)  // like etlc with sanitizers
    const std::string flags = "-O2 -DETLMON_NO_DISPATCH";
#else
    const std::string flags = "-O2";
#endif
    for (const char* compiler : {"g++", "clang++"}) {
        const std::string name = compiler[0] == 'g' ? "Gcc" : "Clang";
        build({name, compiler, flags}, 4000);
        EXPECT_EQ(differing(name), 0U) << compiler;
    }
}

TEST(StrictlyAbove, LeavesANormalDifference) {
    for (const float x : {-3.5F, -1e-20F, 0.0F, 1e-44F, 1.2e-38F, 1e-30F, 0.25F, 1e30F}) {
        const float epsilon = check::strictly_above(static_cast<double>(x));
        EXPECT_GT(epsilon, x);
        EXPECT_GE(epsilon - x, 1.17549435e-38F);
        EXPECT_LE(std::nextafter(epsilon, -INFINITY),
                  std::max(x, x + 1.17549435e-38F));  // the first difference
    }
    EXPECT_TRUE(std::isinf(check::strictly_above(3.4028234663852886e38)));
}

}  // namespace
}  // namespace etlc::tests
