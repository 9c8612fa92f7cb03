// Tests what is calibrated on normal episodes alone. Durations: the score of an episode against the
// verdicts of the same monitor with the duration written in it, and the rate of false alarms in
// drawn episodes. `normal` thresholds and shifts: that rate, from files to deployed monitors.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "calibrate/durations.hpp"
#include "calibrate/shift.hpp"
#include "check/check.hpp"
#include "check/guarantees/conformal.hpp"
#include "compile.hpp"
#include "execute/evaluator.hpp"
#include "npy_bytes.hpp"
#include "parse/parse.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// With ETLC_EFFORT in the environment the simulation draws 2,000 sets of demonstrations.
bool full() {
    return std::getenv("ETLC_EFFORT") != nullptr;
}

/// A formula with D in place of its calibrated duration.
struct Timed {
    const char* formula;
    std::uint32_t least;
    bool longer_is_truer;
};

constexpr Timed kTimed[] = {
    {"F[0, D] a", 0, true},
    {"F[2 steps, D] (a && b)", 2, true},
    {"(!a) U[0, D] b", 0, true},
    {"G (b -> F[0, D] a)", 0, true},
    {"G[0, 6] (a || F[1 step, D] (flag && c))", 1, true},
    {"G !held[D] a", 0, true},
    {"G (c || flag || !(b S[1 step, D] flag))", 1, false},
    {"G (count(a, D) < 2)", 3, false},
    {"F[0, 8] held[D] c", 0, false},
    {"G[0, D] !(a && c)", 0, false},
    {"F[0, 3] G[0, D] b || G !flag", 0, false},
    {"G (flag -> count(c, D) >= 1)", 1, true},
    {"a R[0, D] (b || c)", 0, false},
    {"G[3, inf] fraction(O[0, D] b, 4) > 0.5", 0, true},
    {"G (O[0, D] flag -> !c)", 0, false},
};

std::string spec_text(const std::string& formula) {
    return "spec t; input x, y : f32; input flag : bool; predicate a = x <= 0; predicate b = y > "
           "0;\n"
           "predicate c = x + y < 1 missing true;\nmonitor m = " +
           formula + ";";
}

std::string with(const std::string& formula, const std::string& duration) {
    std::string text = formula;
    return text.replace(text.find('D'), 1, duration);
}

check::Model model_of(const std::string& formula) {
    diag::Sink sink;
    const source::File file("t.etl", spec_text(formula));
    check::Options options;
    options.allow_uncalibrated_monitors = true;
    auto model = check::check(parse::parse(file, sink), file, options, sink);
    EXPECT_TRUE(model) << formula << sink.sorted().front().message;
    return std::move(*model);
}

/// An episode in whole numbers, so that comparisons are often exactly at their threshold.
struct Episode {
    std::vector<std::vector<execute::Sample>> steps;
};

execute::Sample sample(Random& random, double missing, float value) {
    if (random.chance(missing)) return {};
    return {true, {value}};
}

/// `hurry`: how likely x, y and the flag change.
Episode random_episode(Random& random, std::size_t length, double missing, double hurry) {
    Episode episode;
    float x = 1;
    float y = 1;
    float flag = 0;
    while (episode.steps.size() < length) {
        if (random.chance(hurry)) x = static_cast<float>(random.between(0, 3)) - 1;
        if (random.chance(hurry)) y = static_cast<float>(random.between(0, 3)) - 1;
        if (random.chance(hurry)) flag = 1 - flag;
        episode.steps.push_back({sample(random, missing, x), sample(random, missing, y),
                                 sample(random, missing, flag)});
    }
    return episode;
}

/// Knows whether a monitor with a written duration is violated for good by an episode, in a class
/// of robustness or in one of truth values.
class Written {
public:
    explicit Written(const Timed& timed) : timed_(timed) {}

    bool violated(const Episode& episode, std::uint32_t steps) {
        if (!plans_.contains(steps)) {
            const std::string text = with(timed_.formula, fmt::format("{} steps", steps));
            for (const auto values : {check::Values::robustness, check::Values::boolean}) {
                diag::Sink sink;
                plans_[steps].push_back(*compile(model_of(text), {{}, values}, sink));
            }
        }
        return std::any_of(plans_[steps].begin(), plans_[steps].end(), [&](const Compiled& plan) {
            execute::Evaluator evaluator(plan.plan);
            bool alarm = false;
            for (const auto& samples : episode.steps) alarm = evaluator.step(samples)[0].alarm();
            return alarm;
        });
    }

    /// Returns what DurationScorer promises, by trying all durations.
    double score(const Episode& episode) {
        const auto longest = static_cast<std::uint32_t>(episode.steps.size()) + timed_.least + 3;
        double found = kInfinity;
        for (std::uint32_t steps = timed_.least; steps <= longest; ++steps) {
            if (violated(episode, steps)) continue;
            if (timed_.longer_is_truer) return steps;
            found = steps == longest ? -kInfinity : -static_cast<double>(steps);
        }
        return found;
    }

private:
    const Timed& timed_;
    std::map<std::uint32_t, std::vector<Compiled>> plans_;
};

/// Feeds an episode to a scorer, as `etlc calibrate` does.
class Scorer final : public episodes::Frames {
public:
    explicit Scorer(const Timed& timed)
        : model_(model_of(with(timed.formula, "calibrated(conformal, alpha = 0.2)"))),
          scorer_(model_, 0) {
        diag::Sink sink;
        plain_ = compile(model_, {}, sink);
        evaluator_ = std::make_unique<execute::Evaluator>(plain_->plan);
    }
    const check::Duration& duration() const { return *model_.monitors[0].duration; }

    double score(const Episode& episode) {
        scorer_.reset();
        evaluator_->reset();
        for (const auto& samples : episode.steps) {
            samples_ = samples;
            values_.assign(model_.predicates.size(), std::nullopt);
            evaluator_->step(samples);
            for (check::Index p = 0; p < values_.size(); ++p) take(p);
            scorer_.add(values_, *this);
        }
        return *scorer_.score();
    }

    diag::Result<bool> next() override { return true; }
    const std::vector<execute::Sample>& samples() const override { return samples_; }
    episodes::Label label(check::Index) const override { return episodes::Label::unknown; }
    std::uint64_t frames() const override { return 0; }

private:
    /// Scalars are measured alike in all builds.
    void take(check::Index p) {
        const check::Predicate& predicate = model_.predicates[p];
        const float delta = evaluator_->distance(p);
        if (std::isnan(delta)) return;
        const float epsilon = predicate.threshold.value;
        const std::int32_t key =
            etlmon::key_of(predicate.upper_bound() ? epsilon - delta : delta - epsilon);
        values_[p] = {key, key};
    }

    check::Model model_;
    calibrate::DurationScorer scorer_;
    std::optional<Compiled> plain_;
    std::unique_ptr<execute::Evaluator> evaluator_;
    std::vector<std::optional<calibrate::Ends>> values_;
    std::vector<execute::Sample> samples_;
};

TEST(Durations, ScoreIsTheLeastThatIsNotViolatedForGood) {
    for (const Timed& timed : kTimed) {
        Random random(41);
        Written written(timed);
        Scorer scorer(timed);
        EXPECT_EQ(scorer.duration().least, timed.least) << timed.formula;
        EXPECT_EQ(scorer.duration().longer_is_truer, timed.longer_is_truer) << timed.formula;
        int finite = 0;
        for (int i = 0; i < (full() ? 2000 : 100); ++i) {
            const Episode episode =
                random_episode(random, static_cast<std::size_t>(random.between(1, 14)),
                               random.chance(0.5) ? 0.1 : 0, random.chance(0.5) ? 0.6 : 0.2);
            const double expected = written.score(episode);
            EXPECT_EQ(scorer.score(episode), expected) << timed.formula << ", episode " << i;
            finite += std::isinf(expected) ? 0 : 1;
        }
        EXPECT_GT(finite, 0) << timed.formula;
    }
}

/// Calibrates on nine of ten episodes and looks at the tenth, for each of the ten in turn: they are
/// exchangeable. Returns how often the tenth is violated for good, among how many.
std::pair<int, int> false_alarms(const Timed& timed, int sets) {
    Random random(97);
    Written written(timed);
    Scorer scorer(timed);
    check::Monitor monitor;
    monitor.name = "m";
    monitor.duration = scorer.duration();
    int alarms = 0;
    int all = 0;
    for (int set = 0; set < sets; ++set) {
        std::vector<Episode> episodes;
        std::vector<double> scores;
        for (int i = 0; i < 10; ++i) {
            // Ten lengths, ties, and now and then an episode that no duration saves.
            episodes.push_back(
                random_episode(random, static_cast<std::size_t>(random.between(6, 15)), 0.02, 0.3));
            scores.push_back(scorer.score(episodes.back()));
        }
        for (std::size_t last = 0; last < 10; ++last) {
            calibrate::Times times;
            for (std::uint32_t i = 0; i < 10; ++i)
                if (i != last) times.add(scores[i], i - (i > last ? 1 : 0));
            diag::Sink sink;
            const auto entry = calibrate::fit_duration(monitor, times, sink);
            ++all;
            if (!entry) continue;  // refused, so nothing is deployed
            const auto steps = static_cast<std::uint32_t>(*entry->duration);
            alarms += written.violated(episodes[last], steps) ? 1 : 0;
        }
    }
    return {alarms, all};
}

TEST(Durations, FalseAlarmsAreWithinAlpha) {
    for (const Timed& timed : kTimed) {
        const auto [alarms, all] = false_alarms(timed, full() ? 2000 : 60);
        const double rate = static_cast<double>(alarms) / all;
        EXPECT_LE(rate, 0.2 + 3 * std::sqrt(0.2 * 0.8 / all * 10)) << timed.formula;
        fmt::print("{}: {} of {} new episodes are violated for good, alpha = 0.2\n", timed.formula,
                   alarms, all);
    }
}

/// Returns the error for these scores, or the duration.
std::string fitted(const Timed& timed, std::vector<double> scores, bool by_group = false) {
    check::Monitor monitor;
    monitor.name = "m";
    monitor.duration = Scorer(timed).duration();
    diag::Sink sink;
    const auto entry = calibrate::fit_duration(monitor, {std::move(scores), by_group}, sink);
    return entry ? std::to_string(*entry->duration) : sink.sorted().front().message;
}

TEST(Durations, AreRefusedWhereScoresAllowNone) {
    const Timed& truer = kTimed[0];
    const Timed& falser = kTimed[7];
    EXPECT_EQ(fitted(truer, {3, 1, 2}),
              "alpha = 0.2 needs the times of at least 4 demonstrations; there are 3");
    EXPECT_EQ(fitted(truer, {3}, true),
              "alpha = 0.2 needs the times of at least 4 groups; there is 1");
    EXPECT_EQ(fitted(truer, {3, 1, 2, 7}), "7");
    EXPECT_EQ(fitted(truer, {3, 1, 2, 7, 4, 4, 4, 4, kInfinity}), "7");
    EXPECT_EQ(fitted(truer, {3, kInfinity, kInfinity, 1, 2}),
              "'m' is violated for good in 2 of 5 demonstrations, whatever this time is, and alpha "
              "= 0.2 allows 0");
    EXPECT_EQ(fitted(falser, {-3, -9, -5, -4}), "3");
    EXPECT_EQ(fitted(falser, {-kInfinity, -kInfinity, -kInfinity, -kInfinity, -5, -4, -kInfinity,
                              -kInfinity, -kInfinity}),
              "5");
    EXPECT_EQ(fitted(falser, {-kInfinity, -kInfinity, -kInfinity, -kInfinity}),
              "no limit is needed: in 4 of 4 demonstrations, no time violates 'm'");
}

TEST(Durations, OfTheCommandIsTheScoreAtTheRank) {
    for (const Timed& timed : kTimed) {
        Random random(5);
        Written written(timed);
        std::vector<double> scores;
        std::vector<std::unique_ptr<TemporaryPath>> files;
        calibrate::Request request;
        for (int i = 0; i < 12; ++i) {
            const Episode episode = random_episode(random, 20, 0, 0.3);
            std::string text = "x,y,flag\n";
            for (const auto& step : episode.steps)
                text += fmt::format("{},{},{}\n", step[0].values[0], step[1].values[0],
                                    step[2].values[0]);
            files.push_back(std::make_unique<TemporaryPath>(fmt::format("timed{}.csv", i), text));
            request.episodes.push_back(files.back()->path());
            scores.push_back(written.score(episode));
        }
        std::sort(scores.begin(), scores.end());
        const check::Model model =
            model_of(with(timed.formula, "calibrated(conformal, alpha = 0.2)"));
        diag::Sink sink;
        const auto result = calibrate::calibrate_monitors(model, {}, request, sink);
        const double expected = std::abs(scores[check::rank("0.2", 12) - 1]);
        ASSERT_EQ(result.has_value(), !std::isinf(expected)) << timed.formula;
        if (!result) continue;
        const thresholds::Entry& entry = result->file.monitors.at("m");
        EXPECT_EQ(static_cast<double>(*entry.duration), expected) << timed.formula;
        EXPECT_EQ(entry.episodes.size(), 12U);
        // The file is read as it was written, and fits the spec.
        const auto again = thresholds::parse(thresholds::write(result->file), "t.json");
        ASSERT_TRUE(again) << again.failure().message;
        EXPECT_EQ(thresholds::write(*again), thresholds::write(result->file));
        const source::File file(
            "t.etl", spec_text(with(timed.formula, "calibrated(conformal, alpha = 0.2)")));
        check::Options options;
        options.thresholds = &*again;
        diag::Sink found;
        const auto known = check::check(parse::parse(file, found), file, options, found);
        ASSERT_TRUE(known) << found.sorted().front().message;
        EXPECT_EQ(known->monitors[0].duration->steps, *entry.duration);
    }
}

/// Recordings of bools are often alike, and nobody compares them.
TEST(Durations, OfBoolsAlone) {
    const std::string text =
        "spec t; input b : bool; monitor m = F[0, calibrated(conformal, alpha = 0.2)] b;";
    const source::File file("t.etl", text);
    check::Options options;
    options.allow_uncalibrated_monitors = true;
    diag::Sink sink;
    const auto model = check::check(parse::parse(file, sink), file, options, sink);
    ASSERT_TRUE(model);
    const TemporaryPath first("bools1.csv", "b\n0\n0\n1\n0\n");
    const TemporaryPath second("bools2.csv", "b\n0\n0\n1\n0\n");
    const TemporaryPath third("bools3.csv", "b\n0\n0\n0\n1\n");
    const TemporaryPath fourth("bools4.csv", "b\n1\n0\n0\n1\n");
    calibrate::Request request;
    request.episodes = {first.path(), second.path(), third.path(), fourth.path()};
    const auto result = calibrate::calibrate_monitors(*model, {}, request, sink);
    ASSERT_TRUE(result) << sink.sorted().front().message;
    check::Options known;
    known.thresholds = &result->file;
    const auto again = check::check(parse::parse(file, sink), file, known, sink);
    ASSERT_TRUE(again) << sink.sorted().front().message;
    EXPECT_EQ(again->monitors[0].duration->steps, 3U);
}

// ---- normal -------------------------------------------------------------------------------------

/// A spec that is calibrated with `normal`: thresholds of predicates, or of the monitor as a whole.
struct Normal {
    const char* predicate;  ///< what x is compared with
    const char* monitor;
};

constexpr Normal kNormal[] = {
    {"calibrated(normal, alpha = 0.2)", "monitor m = G a"},
    {"calibrated(normal, alpha = 0.2)", "monitor m = G (flag -> F[0, 2] a)"},
    {"calibrated(normal, alpha = 0.2)", "monitor m = G (b -> a) && F[0, 40] a"},
    {"calibrated(normal, alpha = 0.2)", "sliding monitor m = a || X a"},
    {"0", "monitor m = G (b -> F[0, 3] a) calibrated(normal, alpha = 0.2)"},
    {"0", "monitor m = G !held[2 steps] b calibrated(normal, alpha = 0.2)"},
    {"0", "monitor m = F[0, 5] (a && b) calibrated(normal, alpha = 0.2)"},
    {"0", "monitor m = a U[0, 4] b calibrated(normal, alpha = 0.2)"},
    {"0", "sliding monitor m = F[0, 2] c calibrated(normal, alpha = 0.2)"},
};

/// Checks the spec, with these thresholds if there are any.
check::Model normal_model(const Normal& normal, const thresholds::File* known) {
    diag::Sink sink;
    const source::File file(
        "t.etl", fmt::format("spec t; input x, y : f32; input flag : bool; predicate a = x <= {};\n"
                             "predicate b = y > 0; predicate c = x + y < 1;\n{};",
                             normal.predicate, normal.monitor));
    check::Options options;
    options.thresholds = known;
    options.allow_uncalibrated = known == nullptr;
    options.allow_uncalibrated_monitors = known == nullptr;
    auto model = check::check(parse::parse(file, sink), file, options, sink);
    EXPECT_TRUE(model) << normal.monitor << sink.sorted().front().message;
    return std::move(*model);
}

/// Calibrates as `etlc calibrate` does; nothing if it refuses.
std::optional<thresholds::File> fitted_to(const check::Model& model,
                                          const std::vector<std::string>& paths) {
    calibrate::Request request;
    request.episodes = paths;
    request.allow_overlap = "drawn alike";
    request.jobs = 1;
    diag::Sink sink;
    const auto result = model.monitors[0].calibration
                            ? calibrate::calibrate_monitors(model, {}, request, sink)
                            : calibrate::calibrate(model, request, sink);
    if (!result) return std::nullopt;
    return result->file;
}

/// Returns whether the monitor is violated for good at some step or position of the episode.
bool raises_alarm(const Compiled& compiled, const Episode& episode) {
    execute::Evaluator evaluator(compiled.plan);
    bool alarm = false;
    for (const auto& samples : episode.steps) alarm |= evaluator.step(samples)[0].alarm();
    for (std::uint32_t left = compiled.plan.monitors[0].horizon; left > 0; --left)
        alarm |= evaluator.finish()[0].alarm();
    return alarm;
}

TEST(Normal, FalseAlarmsAreWithinAlpha) {
    for (const Normal& normal : kNormal) {
        Random random(71);
        const check::Model model = normal_model(normal, nullptr);
        int alarms = 0;
        int deployed = 0;
        const int sets = full() ? 2000 : 8;
        for (int set = 0; set < sets; ++set) {
            std::vector<Episode> episodes;
            std::vector<std::unique_ptr<TemporaryPath>> files;
            std::vector<std::string> paths;
            for (int i = 0; i < 10; ++i) {
                episodes.push_back(random_episode(
                    random, static_cast<std::size_t>(random.between(6, 15)), 0.02, 0.3));
                const auto size = static_cast<float>(random.between(1, 9));
                for (auto& step : episodes.back().steps)
                    for (float& x : step[0].values) x *= size;
                std::string text = "x,y,flag\n";
                for (const auto& step : episodes.back().steps)
                    for (std::size_t input = 0; input < 3; ++input)
                        text += fmt::format(
                            "{}{}",
                            step[input].present ? fmt::format("{}", step[input].values[0]) : "",
                            input < 2 ? "," : "\n");
                files.push_back(std::make_unique<TemporaryPath>(fmt::format("n{}.csv", i), text));
                paths.push_back(files.back()->path());
            }
            for (std::size_t last = 0; last < 10; ++last) {
                std::vector<std::string> others = paths;
                others.erase(others.begin() + static_cast<std::ptrdiff_t>(last));
                const auto file = fitted_to(model, others);
                if (!file) continue;  // refused, so nothing is deployed
                diag::Sink sink;
                const auto compiled = compile(normal_model(normal, &*file), {}, sink);
                ASSERT_TRUE(compiled);
                ++deployed;
                alarms += raises_alarm(*compiled, episodes[last]) ? 1 : 0;
            }
        }
        const int all = 10 * sets;
        EXPECT_LE(static_cast<double>(alarms) / all, 0.2 + 3 * std::sqrt(0.2 * 0.8 / all * 10))
            << normal.monitor;
        EXPECT_GT(deployed, all / 10) << normal.monitor;
        EXPECT_GT(alarms, 0) << normal.monitor;
        fmt::print("{}: {} false alarms in {} new episodes, {} deployed, alpha = 0.2\n",
                   normal.monitor, alarms, all, deployed);
    }
}

TEST(Normal, IsRefusedWhereNoShiftChangesAnything) {
    const Normal normal{"0", "monitor m = F a calibrated(normal, alpha = 0.2)"};
    const check::Model model = normal_model(normal, nullptr);
    std::vector<std::unique_ptr<TemporaryPath>> files;
    calibrate::Request request;
    for (int i = 0; i < 5; ++i) {
        files.push_back(std::make_unique<TemporaryPath>(
            fmt::format("never{}.csv", i), fmt::format("x,y,flag\n{},0,0\n1,{},0\n", i, i)));
        request.episodes.push_back(files.back()->path());
    }
    diag::Sink sink;
    EXPECT_FALSE(calibrate::calibrate_monitors(model, {}, request, sink));
    EXPECT_EQ(sink.sorted().front().message,
              "of 5 episodes, 0 violate 'm' for good with every shift and 5 with none, so no shift "
              "gives alpha = 0.2");
}

}  // namespace
}  // namespace etlc::tests
