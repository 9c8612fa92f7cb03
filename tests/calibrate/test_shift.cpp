// Tests monitors calibrated as a whole: the shift, and its coverage of drawn episodes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "calibrate/shift.hpp"
#include "check/check.hpp"
#include "execute/evaluator.hpp"
#include "ir/lower.hpp"
#include "npy_bytes.hpp"
#include "parse/parse.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

using calibrate::Index;

constexpr int kShiftSteps = 6;
constexpr int kShiftDraws = 2000;

constexpr const char* kOverPredicate = "F[0, 2] (a && F[0, 2] !a)";
constexpr const char* kOverLet = "F[0, 2] (late && F[0, 2] !late)";  // with the same truth

/// Literal thresholds: only the shift is calibrated. It reads a, which is noisy, and the label px.
std::string spec_text(const std::string& formula, const std::string& against) {
    return fmt::format(
        "spec t; input x, px : f32; predicate a = x <= 0.5; truth a = px > 0.5;\n"
        "let late = O[0, 1] a; truth late = a;\n"
        "monitor m = {} calibrated(conformal, alpha = 0.2, against = {});",
        formula, against);
}

check::Model model_of(const std::string& against, float shift,
                      const std::string& formula = kOverPredicate) {
    diag::Sink sink;
    const source::File file("t.etl", spec_text(formula, against));
    check::Options options;
    options.allow_uncalibrated_monitors = true;
    auto model = *check::check(parse::parse(file, sink), file, options, sink);
    model.monitors[0].calibration->value = shift;
    return model;
}

struct Planned {
    check::Model model;
    ir::Program program;
    plan::Plan plan;

    explicit Planned(check::Model of) : model(std::move(of)), program(ir::lower(model)) {
        diag::Sink sink;
        plan = *plan::plan(program, {}, sink);
    }
    Planned(const Planned&) = delete;
};

struct ShiftedEpisode {
    std::vector<float> x;
    std::vector<bool> label;
};

ShiftedEpisode random_episode(Random& random) {
    ShiftedEpisode episode;
    for (int t = 0; t < kShiftSteps; ++t) {
        episode.label.push_back(random.chance(0.4));
        episode.x.push_back(
            static_cast<float>((episode.label.back() ? 0.0 : 1.0) + 2 * (random.uniform() - 0.5)));
    }
    return episode;
}

struct Runs {
    std::vector<etlmon::Verdict> predicted, truth;
};

Runs run(execute::Evaluator& predicted, execute::Evaluator& truth, const ShiftedEpisode& episode) {
    Runs runs;
    predicted.reset();
    truth.reset();
    for (std::size_t t = 0; t < kShiftSteps; ++t) {
        const execute::Sample x{true, {episode.x[t]}};
        const execute::Sample px{true, {episode.label[t] ? 1.0F : 0.0F}};
        runs.predicted.push_back(predicted.step({x, px})[0]);
        runs.truth.push_back(truth.step({x, px, px})[0]);
    }
    return runs;
}

/// Returns the worst rho where the truth must not be missed, by hand.
std::optional<double> score(const Runs& runs, bool alarms) {
    std::optional<double> worst;
    for (std::size_t t = 0; t < runs.predicted.size(); ++t) {
        if (alarms ? !runs.truth[t].violated() : !runs.truth[t].satisfied()) continue;
        const double rho = (alarms ? 1 : -1) * static_cast<double>(runs.predicted[t].robustness);
        worst = std::max(worst.value_or(rho), rho);
    }
    return worst;
}

TEST(Shift, CoversDrawnEpisodes) {
    for (const std::string against : {"missed_alarm", "missed_success"}) {
        const bool alarms = against == "missed_alarm";
        const Planned unshifted(calibrate::unshifted(model_of(against, 0)));
        const Planned truths(episodes::ground_truth(unshifted.model, {0}).model);
        execute::Evaluator predicted(unshifted.plan);
        execute::Evaluator truth(truths.plan);
        Random random(77);
        int covered = 0;
        for (int draw = 0; draw < kShiftDraws; ++draw) {
            std::vector<double> scores;
            while (scores.size() < 9)
                if (const auto one = score(run(predicted, truth, random_episode(random)), alarms))
                    scores.push_back(*one);
            const auto fit = std::get<calibrate::Fitted>(calibrate::fit_rank(scores, "0.2"));
            ASSERT_EQ(fit.k, 8U);
            const ShiftedEpisode test = random_episode(random);
            const Planned shifted(model_of(against, alarms ? fit.epsilon : -fit.epsilon));
            execute::Evaluator calibrated(shifted.plan);
            const Runs before = run(predicted, truth, test);
            const Runs after = run(calibrated, truth, test);
            bool missed = false;
            for (std::size_t t = 0; t < after.predicted.size(); ++t) {
                const float shift = alarms ? fit.epsilon : -fit.epsilon;
                ASSERT_EQ(after.predicted[t].robustness, before.predicted[t].robustness - shift);
                ASSERT_EQ(after.predicted[t].lower, before.predicted[t].lower - shift);
                ASSERT_EQ(after.predicted[t].upper, before.predicted[t].upper - shift);
                missed = missed ||
                         (alarms ? after.truth[t].violated() && after.predicted[t].satisfied()
                                 : after.truth[t].satisfied() && after.predicted[t].violated());
            }
            covered += missed ? 0 : 1;
            const auto own = score(before, alarms);
            ASSERT_FALSE(missed && (!own || *own < static_cast<double>(fit.epsilon)));
        }
        EXPECT_GE(static_cast<double>(covered) / kShiftDraws,
                  0.8 - 3 * std::sqrt(0.2 * 0.8 / kShiftDraws))
            << against;
    }
}

/// Compares the shift of the whole command with the score computed by hand; returns the entry.
thresholds::Entry shift_at_the_rank(const std::string& formula, const std::string& against) {
    const bool alarms = against == "missed_alarm";
    const check::Model model = model_of(against, 0, formula);
    const Planned unshifted(calibrate::unshifted(model));
    const Planned truths(episodes::ground_truth(unshifted.model, {0}).model);
    execute::Evaluator predicted(unshifted.plan);
    execute::Evaluator truth(truths.plan);
    Random random(78);
    std::vector<double> scores;
    std::vector<std::unique_ptr<TemporaryPath>> files;
    calibrate::Request request;
    for (int i = 0; i < 15; ++i) {
        const ShiftedEpisode episode = random_episode(random);
        std::string text = "x,px\n";
        for (std::size_t t = 0; t < kShiftSteps; ++t)
            text += fmt::format("{},{}\n", episode.x[t], episode.label[t] ? 1 : 0);
        files.push_back(std::make_unique<TemporaryPath>(fmt::format("shift{}.csv", i), text));
        request.episodes.push_back(files.back()->path());
        if (const auto one = score(run(predicted, truth, episode), alarms)) scores.push_back(*one);
    }
    std::sort(scores.begin(), scores.end());
    diag::Sink sink;
    const auto result = calibrate::calibrate_monitors(model, {}, request, sink);
    EXPECT_TRUE(result);
    const thresholds::Entry& entry = result->file.monitors.at("m");
    EXPECT_EQ(entry.n, scores.size());
    const auto expected = std::nextafter(static_cast<float>(scores[entry.k - 1]), INFINITY);
    EXPECT_EQ(entry.epsilon, alarms ? expected : -expected) << against;
    EXPECT_EQ(entry.against, against);
    EXPECT_EQ(entry.episodes.size(), 15U);
    return entry;
}

TEST(Shift, IsBeyondTheScoreAtTheRank) {
    for (const std::string against : {"missed_alarm", "missed_success"}) {
        const thresholds::Entry plain = shift_at_the_rank(kOverPredicate, against);
        EXPECT_EQ(plain.reads.at("formula m"), "F[0, 2] (a && F[0, 2] !a)");
        EXPECT_EQ(plain.reads.at("predicate a"), "x <= 0.5");
        EXPECT_EQ(plain.reads.at("truth a"), "px > 0.5");
        const thresholds::Entry of_let = shift_at_the_rank(kOverLet, against);
        EXPECT_EQ(of_let.reads.at("formula m"), "F[0, 2] (O[0, 1] a && F[0, 2] !O[0, 1] a)");
        EXPECT_EQ(of_let.reads.at("truth of the formula m"), "F[0, 2] (a && F[0, 2] !a)");
    }
}

}  // namespace
}  // namespace etlc::tests
