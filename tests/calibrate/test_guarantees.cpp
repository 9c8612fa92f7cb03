// Tests the guarantees of calibrated thresholds: their texts, and whether they hold for drawn
// episodes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calibrate/fit.hpp"
#include "check/check.hpp"
#include "check/guarantees/guarantees.hpp"
#include "episodes/truth.hpp"
#include "execute/evaluator.hpp"
#include "ir/lower.hpp"
#include "parse/parse.hpp"
#include "plan/plan.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

using calibrate::Index;
using check::Guarantee;

check::Model load_uncalibrated(const std::string& text) {
    diag::Sink sink;
    const source::File file("t.etl", text);
    check::Options options;
    options.allow_uncalibrated = true;
    auto model = check::check(parse::parse(file, sink), file, options, sink);
    EXPECT_TRUE(model) << text;
    return *model;
}

constexpr const char* kDeclarations =
    "spec t; input z : f32[2]; input s, x, y : f32; input flag : bool; target g = [[0, 0]];\n"
    "predicate a = l2(z, g) <= calibrated(conformal, alpha = 0.10);\n"
    "predicate b = x <= calibrated(conformal, alpha = 0.05);\n"
    "predicate e = y <= calibrated(f1);\n"
    "predicate c = y <= calibrated(class_conditional, alpha = 0.1);\n"
    "predicate literal = l2(z, g) <= 0.5;\n"
    "predicate near = l2([x, y], g) <= 1;\n"
    "predicate half = x <= calibrated(conformal, alpha = 0.5); predicate rest = y <= "
    "calibrated(conformal, alpha = 5e-1);\n"
    "predicate meant = s > 1; truth meant = s > 2;\n"
    "predicate two = x <= calibrated(conformal, alpha = 0.1, beta = 0.05, against = both);\n"
    "predicate same = y <= calibrated(conformal, alpha = 0.02, against = both);\n"
    "predicate few = x <= calibrated(conformal, alpha = 0.1, against = false_positives);\n"
    "predicate surely = x <= calibrated(conformal, alpha = 0.1, against = both) missing true;\n"
    "predicate never = x <= calibrated(conformal, alpha = 0.1, against = both) missing false;\n"
    "predicate share = x <= calibrated(risk, alpha = 0.1, against = both);\n"
    "predicate usual = x <= calibrated(normal, alpha = 0.1);\n"
    "predicate gapless = y <= calibrated(normal, alpha = 0.1) missing false;\n"
    "let after = !a && O a; truth after = flag;\n";

/// Returns all guarantees of one monitor, the parts in brackets.
std::string guarantees_of(const std::string& formula) {
    const check::Model model =
        load_uncalibrated(std::string(kDeclarations) + "monitor m = " + formula + ";");
    std::string result;
    for (const Guarantee& guarantee : check::guarantees(model, model.monitors[0])) {
        if (!result.empty()) result += " | ";
        result += check::text(guarantee);
    }
    return result;
}

TEST(Guarantees, AreReadOffTheNegationNormalForm) {
    const std::string success = "P(some verdict of a new episode misses a success) <= ";
    const std::string alarm = "P(some verdict of a new episode misses an alarm) <= ";
    EXPECT_EQ(guarantees_of("F a"), success + "0.1");
    EXPECT_EQ(guarantees_of("F (a && F b)"), success + "0.15");
    EXPECT_EQ(guarantees_of("F (a && F a)"),
              success + "0.1");  // one event, counted once
    EXPECT_EQ(guarantees_of("G !a"), alarm + "0.1");
    EXPECT_EQ(guarantees_of("!(F a || F b)"), alarm + "0.15");
    EXPECT_EQ(guarantees_of("G (a -> s >= 0.5)"), alarm + "0.1");
    EXPECT_EQ(guarantees_of("G (s > 0.5 -> F[0, 3] a)"), success + "0.1");
    EXPECT_EQ(guarantees_of("flag U a"), success + "0.1");
    EXPECT_EQ(guarantees_of("F held[3] a"), success + "0.1");
    EXPECT_EQ(guarantees_of("G !held[3] a"), alarm + "0.1");
    EXPECT_EQ(guarantees_of("G (near -> F a)"),
              success + "0.1");  // on scalars alone: its own truth
    EXPECT_EQ(
        guarantees_of("F (s > 0.5 && flag)"),
        "exact, except at robustness 0: no predicate is calibrated, and each is its own truth");
}

TEST(Guarantees, NothingWhereNothingIsKnown) {
    EXPECT_EQ(guarantees_of("F e"), "no guarantee: 'e' is calibrated for F1");
    EXPECT_EQ(guarantees_of("F (a && c)"),
              "no guarantee: 'c' is calibrated for frames, not episodes");
    EXPECT_EQ(guarantees_of("F (a && literal)"),
              "no guarantee: 'literal' has a threshold that was not calibrated");
    EXPECT_EQ(guarantees_of("F (a && meant)"),
              "no guarantee: 'meant' has a threshold that was not calibrated");
    EXPECT_EQ(guarantees_of("F (a && !b)"), "no guarantee: 'a' occurs plain and 'b' negated");
    EXPECT_EQ(guarantees_of("F (a <-> flag)"), "no guarantee: 'a' occurs both plain and negated");
    EXPECT_EQ(guarantees_of("G !rise a"), "no guarantee: 'a' occurs both plain and negated");
    EXPECT_EQ(guarantees_of("F fall a"), "no guarantee: 'a' occurs both plain and negated");
    EXPECT_EQ(guarantees_of("F (half && rest)"),
              "no guarantee: the alphas of its predicates add up to 1");
}

/// The truth of a predicate by `normal` is that it holds.
TEST(Guarantees, OfNormalEpisodes) {
    const std::string alarms = "P(a false alarm in a new normal episode) <= 0.1";
    EXPECT_EQ(guarantees_of("G usual"), alarms);
    EXPECT_EQ(guarantees_of("G !held[3] !usual"), alarms);
    EXPECT_EQ(guarantees_of("G (flag -> F[0, 3] usual)"), alarms);
    EXPECT_EQ(guarantees_of("G (s <= 1) calibrated(normal, alpha = 0.1)"), alarms);
    const std::string verdict = "P(some verdict of a new normal episode is ";
    EXPECT_EQ(guarantees_of("F !usual"), verdict + "satisfied wrongly) <= 0.1");
    EXPECT_EQ(guarantees_of("G (usual && b)"), verdict + "violated wrongly) <= 0.15");
    EXPECT_EQ(guarantees_of("G gapless"),
              "no guarantee: 'gapless' is false when its sample is missing");
    EXPECT_EQ(guarantees_of("G (usual <-> flag)"),
              "no guarantee: 'usual' occurs both plain and negated");
    EXPECT_EQ(guarantees_of("G (usual && !a)"),
              "no guarantee: 'usual' occurs plain and 'a' negated");
}

/// Predicates against both errors bound both, for formulas of any polarity.
TEST(Guarantees, OfPredicatesAgainstBothErrors) {
    const auto lines = [](const char* satisfied, const char* violated, const char* either) {
        const std::string p = "P(some verdict of a new episode is ";
        return p + "satisfied wrongly) <= " + satisfied + " | " + p +
               "violated wrongly) <= " + violated + " | " + p + "wrong) <= " + either;
    };
    EXPECT_EQ(guarantees_of("F two"), lines("0.05", "0.1", "0.15"));
    EXPECT_EQ(guarantees_of("G !two"), lines("0.1", "0.05", "0.15"));
    EXPECT_EQ(guarantees_of("G (two -> F same)"), lines("0.12", "0.07", "0.19"));
    EXPECT_EQ(guarantees_of("F (two <-> flag)"), lines("0.15", "0.15", "0.15"));
    EXPECT_EQ(
        guarantees_of("F (two && s > 1)"),
        "P(some verdict of a new episode is satisfied wrongly) <= 0.05, except at robustness 0"
        " | P(some verdict of a new episode is violated wrongly) <= 0.1"
        " | P(some verdict of a new episode is wrong) <= 0.15, except at robustness 0");
    // One error is bounded where the bounds of all predicates are on its side.
    EXPECT_EQ(guarantees_of("F (two && a)"),
              "P(some verdict of a new episode is violated wrongly) <= 0.2");
    EXPECT_EQ(guarantees_of("F (two && !a)"),
              "P(some verdict of a new episode is satisfied wrongly) <= 0.15");
    EXPECT_EQ(guarantees_of("F (two && a && !b)"),
              "no guarantee: 'a' occurs plain and 'b' negated");
    // What counts as true or false where it is missing has no bound against that.
    EXPECT_EQ(guarantees_of("F surely"),
              "P(some verdict of a new episode is violated wrongly) <= 0.1");
    EXPECT_EQ(guarantees_of("G !surely"),
              "P(some verdict of a new episode is satisfied wrongly) <= 0.1");
    EXPECT_EQ(guarantees_of("F never"),
              "P(some verdict of a new episode is satisfied wrongly) <= 0.1");
    // One-sided ones against false positives.
    EXPECT_EQ(guarantees_of("F few"), "P(some verdict of a new episode misses an alarm) <= 0.1");
    EXPECT_EQ(guarantees_of("G !few"), "P(some verdict of a new episode misses a success) <= 0.1");
    EXPECT_EQ(guarantees_of("F (few && !a)"),
              "P(some verdict of a new episode misses an alarm) <= 0.2");
    EXPECT_EQ(guarantees_of("F (few && a)"),
              "no guarantee: 'a' may make it satisfied wrongly and 'few' violated wrongly");
    EXPECT_EQ(guarantees_of("F share"),
              "no guarantee: 'share' is calibrated for a share of the frames, not for each");
}

TEST(Guarantees, OfMonitorsAgainstBothErrors) {
    const std::string p = "P(some verdict of a new episode is ";
    EXPECT_EQ(guarantees_of("F two calibrated(conformal, alpha = 0.1, against = both)"),
              p + "satisfied wrongly) <= 0.1 | " + p + "violated wrongly) <= 0.1 | " + p +
                  "wrong) <= 0.2");
    EXPECT_EQ(
        guarantees_of("F two calibrated(risk, alpha = 0.1, beta = 0.025, against = both)"),
        "on average over calibrations and new episodes, satisfied at no more than 2.5 % of the "
        "steps at which it is truly violated"
        " | on average over calibrations and new episodes, violated at no more than 10 % of "
        "the steps at which it is truly satisfied");
    EXPECT_EQ(
        guarantees_of("F two calibrated(risk, alpha = 0.1, against = missed_alarm)"),
        "on average over calibrations and new episodes, satisfied at no more than 10 % of the "
        "steps at which it is truly violated");
}

/// The predicates of the let keep to truths that are not those of the let.
TEST(Guarantees, NothingOfALetWithATruth) {
    const std::string why =
        "no guarantee: 'after' has a truth of its own, to which no threshold was calibrated";
    EXPECT_EQ(guarantees_of("F after"), why);
    EXPECT_EQ(guarantees_of("after"), why);
    EXPECT_EQ(guarantees_of("after && F b"),
              why + " | part !a && O a: " + why +
                  " | part F b: P(some verdict of a new episode misses a success) <= 0.05");
}

TEST(Guarantees, MixedConjunctsSpeakForThemselves) {
    EXPECT_EQ(guarantees_of("F a && G !b"),
              "no guarantee: 'a' occurs plain and 'b' negated"
              " | part F a: P(some verdict of a new episode misses a success) <= 0.1"
              " | part G !b: P(some verdict of a new episode misses an alarm) <= 0.05");
    EXPECT_EQ(guarantees_of("!(G a -> F b)"),
              "no guarantee: 'a' occurs plain and 'b' negated"
              " | part G a: P(some verdict of a new episode misses a success) <= 0.1"
              " | part !(F b): P(some verdict of a new episode misses an alarm) <= 0.05");
    EXPECT_EQ(guarantees_of("F a && F e"),
              "no guarantee: 'e' is calibrated for F1"
              " | part F a: P(some verdict of a new episode misses a success) <= 0.1"
              " | part F e: no guarantee: 'e' is calibrated for F1");
}

// ---- simulation ---------------------------------------------------------------------------------

constexpr int kEpisodeSteps = 8;
constexpr int kDemonstrations = 12;
constexpr int kGuaranteeDraws = 2000;

struct ScoredEpisode {
    std::vector<std::vector<execute::Sample>> samples;  ///< x, y, s
    std::vector<bool> a, b;
};

/// Near 0 where the label holds, near 1 where it does not, with enough noise to overlap.
float noisy(Random& random, bool label) {
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += random.uniform() - 0.5;
    return static_cast<float>((label ? 0.0 : 1.0) + 0.8 * sum);
}

ScoredEpisode random_scored_episode(Random& random) {
    ScoredEpisode episode;
    const double share = random.uniform();  // episodes differ, so frames are not exchangeable
    for (int t = 0; t < kEpisodeSteps; ++t) {
        episode.a.push_back(random.chance(share));
        episode.b.push_back(random.chance(0.2));
        const float s = random.chance(0.3) ? 1.0F : 0.0F;
        episode.samples.push_back({{true, {noisy(random, episode.a.back())}},
                                   {true, {noisy(random, episode.b.back())}},
                                   {true, {s}}});
    }
    return episode;
}

/// One per predicate.
std::vector<calibrate::Scores> score(const ScoredEpisode& episode) {
    std::vector<calibrate::Scores> result(2);
    for (int t = 0; t < kEpisodeSteps; ++t)
        for (std::size_t p = 0; p < 2; ++p) {
            if (!(p == 0 ? episode.a : episode.b)[static_cast<std::size_t>(t)]) continue;
            calibrate::Scores& scores = result[p];
            const float delta = episode.samples[static_cast<std::size_t>(t)][p].values[0];
            scores.positives.add(static_cast<double>(delta), false);
        }
    return result;
}

struct Steppable {
    ir::Program program;
    plan::Plan plan;
    execute::Evaluator evaluator;

    explicit Steppable(const check::Model& model)
        : program(ir::lower(model)), plan(planned(program)), evaluator(plan) {}

private:
    static plan::Plan planned(ir::Program& program) {
        diag::Sink sink;
        return *plan::plan(program, {}, sink);
    }
};

TEST(Guarantees, AreTrueOfDrawnEpisodes) {
    // Positive, negative, mixed; the conjuncts of the mixed one are the monitors after it.
    check::Model model = load_uncalibrated(
        "spec t; input x, y, s : f32;\n"
        "predicate a = x <= calibrated(conformal, alpha = 0.2); predicate b = y <= "
        "calibrated(conformal, alpha = 0.1);\n"
        "monitor p0 = F (a && F b); monitor p1 = G (s > 0.5 -> F[0, 3] a); monitor p2 = a U b;\n"
        "monitor n0 = G !a; monitor n1 = G (a -> s > 0.5); monitor n2 = !a U (s > 0.5 && !b);\n"
        "monitor m0 = G (s > 0.5 -> a) && G !b; monitor c0 = G (s > 0.5 -> a); monitor c1 = G !b;");
    const episodes::GroundTruth truth = episodes::ground_truth(model, {0, 1});
    Steppable monitors(model);
    Steppable truths(truth.model);
    Random random(2026);
    std::vector<int> missed_success(model.monitors.size());
    std::vector<int> missed_alarm(model.monitors.size());
    int draws = 0;
    for (int draw = 0; draw < kGuaranteeDraws; ++draw) {
        calibrate::Evidence evidence[2];
        for (int i = 0; i < kDemonstrations; ++i) {
            const std::vector<calibrate::Scores> scores = score(random_scored_episode(random));
            for (const Index p : {0U, 1U}) evidence[p].add(scores[p], evidence[p].groups);
        }
        const ScoredEpisode test = random_scored_episode(random);
        bool fitted = true;
        for (const Index p : {0U, 1U}) {
            const auto fit = calibrate::fit(
                model.predicates[p], calibrate::aims_of(model.predicates[p])[0], evidence[p]);
            if (const auto* found = std::get_if<calibrate::Fitted>(&fit))
                monitors.evaluator.state().thresholds[p] = found->epsilon;
            else
                fitted = false;
        }
        if (!fitted) continue;  // too few demonstrations with a positive frame
        ++draws;
        monitors.evaluator.reset();
        truths.evaluator.reset();
        std::vector<bool> success(model.monitors.size());
        std::vector<bool> alarm(model.monitors.size());
        for (std::size_t t = 0; t < kEpisodeSteps; ++t) {
            std::vector<execute::Sample> samples = test.samples[t];
            const auto& predicted = monitors.evaluator.step(samples);
            samples.push_back({true, {test.a[t] ? 1.0F : 0.0F}});
            samples.push_back({true, {test.b[t] ? 1.0F : 0.0F}});
            const auto& meant = truths.evaluator.step(samples);
            for (std::size_t m = 0; m < predicted.size(); ++m) {
                if (meant[m].satisfied() && !predicted[m].satisfied()) success[m] = true;
                if (meant[m].violated() && !predicted[m].violated()) alarm[m] = true;
            }
        }
        for (std::size_t m = 0; m < success.size(); ++m) {
            missed_success[m] += success[m] ? 1 : 0;
            missed_alarm[m] += alarm[m] ? 1 : 0;
        }
    }
    ASSERT_GT(draws, kGuaranteeDraws / 2);
    int vacuous = 0;
    for (std::size_t m = 0; m < model.monitors.size(); ++m) {
        const check::Guarantee guarantee = check::guarantees(model, model.monitors[m])[0];
        if (guarantee.kind == Guarantee::Kind::nothing) {
            EXPECT_EQ(model.monitors[m].name, "m0");
            continue;
        }
        const bool of_success = guarantee.kind == Guarantee::Kind::missed_success;
        const double bound = std::stod(guarantee.bound);
        const double share =
            static_cast<double>((of_success ? missed_success : missed_alarm)[m]) / draws;
        const double other =
            static_cast<double>((of_success ? missed_alarm : missed_success)[m]) / draws;
        EXPECT_LE(share, bound + 3 * std::sqrt(bound * (1 - bound) / draws))
            << model.monitors[m].name;
        // There is no guarantee about the other kind of error, and there could be none.
        vacuous += other > bound ? 1 : 0;
    }
    EXPECT_GE(vacuous, 4);
}

}  // namespace
}  // namespace etlc::tests
