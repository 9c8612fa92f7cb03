// Compares thresholds with brute force: every method and comparison, ties, n from 1 to 200.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <optional>

#include "calibrate/calibrate.hpp"
#include "calibrate/fit.hpp"
#include "check/check.hpp"
#include "check/guarantees/calibrated.hpp"
#include "check/guarantees/conformal.hpp"
#include "npy_bytes.hpp"
#include "parse/parse.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

using calibrate::Fitted;
using calibrate::Refusal;
using calibrate::Scores;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Frame {
    float delta = 0;
    bool positive = false;
};
using Episode = std::vector<Frame>;

check::Model model_of(const std::string& comparison, const std::string& threshold) {
    const std::string text = fmt::format(
        "spec t; input x, y : f32; predicate p = x {} {}; truth p = y > 0; monitor m = F p;",
        comparison, threshold);
    diag::Sink sink;
    const source::File file("t.etl", text);
    check::Options options;
    options.allow_uncalibrated = true;
    return *check::check(parse::parse(file, sink), file, options, sink);
}

/// Returns the scores of these episodes for exact scalars, by the definitions of
/// docs/calibration.md.
calibrate::Evidence evidence(const std::vector<Episode>& episodes, bool upper) {
    calibrate::Evidence result;
    for (const Episode& episode : episodes) {
        Scores scores;
        for (const Frame& frame : episode) {
            const float score = upper ? frame.delta : -frame.delta;
            scores.labelled.push_back({score, frame.positive});
            ++scores.side(frame.positive).frames;
            if (frame.positive) scores.positives.add(static_cast<double>(score), true);
        }
        result.add(scores, result.groups);
    }
    return result;
}

/// Fits the threshold against misses.
calibrate::Fit fit_misses(const check::Predicate& predicate, const calibrate::Evidence& evidence) {
    return calibrate::fit(predicate, calibrate::aims_of(predicate)[0], evidence);
}

bool holds(const std::string& comparison, float delta, float epsilon) {
    if (comparison == "<=") return delta <= epsilon;
    if (comparison == "<") return delta < epsilon;
    if (comparison == ">=") return delta >= epsilon;
    return delta > epsilon;
}

std::vector<Episode> random_episodes(Random& random, int n) {
    std::vector<Episode> episodes(static_cast<std::size_t>(n));
    const double grain = random.chance(0.5) ? 0.25 : 0.001;  // many or few ties
    for (Episode& episode : episodes)
        for (int t = random.between(1, 6); t-- > 0;)
            episode.push_back({static_cast<float>(random.grid(-2, 2, grain)), random.chance(0.5)});
    return episodes;
}

/// Returns nothing if there is none.
std::optional<float> threshold(const check::Predicate& predicate,
                               const std::vector<Episode>& episodes) {
    const auto fit = fit_misses(predicate, evidence(episodes, predicate.upper_bound()));
    const auto* const fitted = std::get_if<Fitted>(&fit);
    return fitted == nullptr ? std::nullopt : std::optional(fitted->epsilon);
}

TEST(Fitted, EachIsLeftOutAsByACallOnTheOthers) {
    Random random(43);
    int found = 0;
    for (const std::string comparison : {"<=", "<", ">=", ">"}) {
        for (const std::string method :
             {"conformal, alpha = 0.3", "class_conditional, alpha = 0.2", "f1"}) {
            for (int n = 1; n <= 64; ++n) {
                const auto model = model_of(comparison, fmt::format("calibrated({})", method));
                const check::Predicate& predicate = model.predicates[0];
                const auto episodes = random_episodes(random, n);
                episodes::Identities identities;
                for (int e = 0; e < n; ++e)
                    identities.add({.path = {}, .hash = fmt::format("{:016x}", e * 77 % 64)});
                const auto out =
                    calibrate::left_out(predicate, evidence(episodes, predicate.upper_bound()),
                                        identities, episodes::Groups(identities));
                ASSERT_EQ(out.parts, 0U);
                bool all = true;
                for (std::size_t e = 0; e < episodes.size(); ++e) {
                    std::vector<Episode> others = episodes;
                    others.erase(others.begin() + static_cast<std::ptrdiff_t>(e));
                    const auto expected = threshold(predicate, others);
                    all = all && expected;
                    if (out.why.empty()) {
                        ASSERT_EQ(out.thresholds[e].value, expected);
                    }
                }
                ASSERT_EQ(out.thresholds.size(), all ? episodes.size() : 0U) << method << n;
                ASSERT_EQ(out.why.empty(), all);
                found += all ? 1 : 0;
            }
        }
    }
    EXPECT_GT(found, 600);
}

/// Returns the least covering number of `sorted` (worst first): every threshold on the right side
/// of it covers k of them.
TEST(Fitted, RanksAsBruteForceDoes) {
    Random random(41);
    for (const std::string comparison : {"<=", "<", ">=", ">"}) {
        const bool upper = comparison[0] == '<';
        for (const std::string method : {"conformal", "class_conditional"}) {
            for (int n = 1; n <= 200; ++n) {
                const int percent = random.between(1, 99);
                const auto model = model_of(
                    comparison, fmt::format("calibrated({}, alpha = 0.{:02})", method, percent));
                const auto episodes = random_episodes(random, n);
                std::vector<float> scores;
                for (const Episode& episode : episodes) {
                    std::vector<float> deltas;
                    for (const Frame& frame : episode)
                        if (frame.positive) deltas.push_back(frame.delta);
                    if (deltas.empty()) continue;
                    if (method == "class_conditional")
                        scores.insert(scores.end(), deltas.begin(), deltas.end());
                    else
                        scores.push_back(upper ? *std::max_element(deltas.begin(), deltas.end())
                                               : *std::min_element(deltas.begin(), deltas.end()));
                }
                const auto count = scores.size();
                const std::size_t k =
                    ((100 - static_cast<std::size_t>(percent)) * (count + 1) + 99) / 100;
                const auto fit = fit_misses(model.predicates[0], evidence(episodes, upper));
                if (count == 0 || k > count) {
                    ASSERT_EQ(std::get<Refusal>(fit),
                              count == 0 ? Refusal::no_positives : Refusal::too_few);
                    continue;
                }
                const auto& fitted = std::get<Fitted>(fit);
                ASSERT_EQ(fitted.n, count);
                ASSERT_EQ(fitted.k, k);
                // The least (mirrored: the greatest) float32 strictly beyond at least k of the
                // scores, tried one by one.
                float expected = upper ? kInfinity : -kInfinity;
                for (const float score : scores) {
                    float candidate = std::nextafter(score, upper ? kInfinity : -kInfinity);
                    if (std::abs(score) < FLT_MIN)
                        candidate = std::nextafter(upper ? FLT_MIN : -FLT_MIN,
                                                   upper ? kInfinity : -kInfinity);
                    const auto beyond = std::count_if(scores.begin(), scores.end(), [&](float s) {
                        return upper ? s < candidate : s > candidate;
                    });
                    if (static_cast<std::size_t>(beyond) < k) continue;
                    expected =
                        upper ? std::min(expected, candidate) : std::max(expected, candidate);
                }
                ASSERT_EQ(fitted.epsilon, expected) << comparison << " " << method << " " << n;
                ASSERT_EQ(fitted.scores.size(), method == "conformal" ? count : 1);
                ASSERT_TRUE(std::is_sorted(fitted.scores.begin(), fitted.scores.end()));
                const std::size_t at = method == "conformal" ? check::at_rank(k, count, upper) : 0;
                ASSERT_EQ(check::beyond(fitted.scores[at], upper), expected);
            }
        }
    }
}

/// An adaptive threshold starts at the conformal one, or just beyond it if its grid (here 2^-23) is
/// coarser.
TEST(Fitted, AdaptiveOnesStartAtTheConformalThreshold) {
    Random random(44);
    int outside = 0;
    for (const std::string comparison : {"<=", "<", ">=", ">"}) {
        const bool upper = comparison[0] == '<';
        const auto conformal = model_of(comparison, "calibrated(conformal, alpha = 0.2)");
        const auto adaptive = model_of(
            comparison, "calibrated(adaptive, alpha = 0.2, gamma = 0.1, lo = -1.5, hi = 1.5)");
        for (int n = 1; n <= 200; ++n) {
            const auto all = evidence(random_episodes(random, n), upper);
            const auto expected = fit_misses(conformal.predicates[0], all);
            const auto fit = fit_misses(adaptive.predicates[0], all);
            if (const auto* refusal = std::get_if<Refusal>(&expected)) {
                ASSERT_EQ(std::get<Refusal>(fit), *refusal);
                continue;
            }
            const auto& fitted = std::get<Fitted>(expected);
            if (std::abs(fitted.epsilon) > 1.5F) {
                ++outside;
                ASSERT_EQ(std::get<calibrate::OutOfRange>(fit).epsilon, fitted.epsilon);
                continue;
            }
            const auto& unmoved = std::get<Fitted>(fit);
            ASSERT_EQ(unmoved.epsilon, fitted.epsilon);
            ASSERT_EQ(unmoved.scores, fitted.scores);
            ASSERT_EQ(unmoved.k, fitted.k);
            const float start =
                *check::start(*adaptive.predicates[0].threshold.adaptation, unmoved.epsilon, upper);
            const float beyond = upper ? start - fitted.epsilon : fitted.epsilon - start;
            ASSERT_GE(beyond, 0);
            ASSERT_LT(beyond, 0x1p-23F);
            ASSERT_EQ(start, std::round(start * 0x1p23F) * 0x1p-23F);
        }
    }
    EXPECT_GT(outside, 10);
}

/// Returns the observed value next to `taken` on the side where the result changes, if any: above
/// for <= and >, below for < and >=.
std::optional<float> next_observed(const std::string& comparison, float taken,
                                   const std::vector<Episode>& episodes) {
    const bool above = comparison == "<=" || comparison == ">";
    std::optional<float> next;
    for (const Episode& episode : episodes)
        for (const Frame& frame : episode) {
            if (above ? !(frame.delta > taken) : !(frame.delta < taken)) continue;
            if (!next || (above ? frame.delta < *next : frame.delta > *next)) next = frame.delta;
        }
    return next;
}

TEST(Fitted, F1AsBruteForceDoes) {
    Random random(42);
    for (const std::string comparison : {"<=", "<", ">=", ">"}) {
        const bool upper = comparison[0] == '<';
        const auto model = model_of(comparison, "calibrated(f1)");
        for (int n = 1; n <= 200; ++n) {
            const auto episodes = random_episodes(random, n);
            double best = 0;
            float expected = 0;
            std::size_t frames = 0;
            bool any_positive = false;
            for (const Episode& candidates : episodes) {
                for (const Frame& candidate : candidates) {
                    const float epsilon = candidate.delta;
                    double true_positives = 0, found = 0, positives = 0;
                    frames = 0;
                    for (const Episode& episode : episodes)
                        for (const Frame& frame : episode) {
                            ++frames;
                            const bool claimed = holds(comparison, frame.delta, epsilon);
                            true_positives += claimed && frame.positive ? 1 : 0;
                            found += claimed ? 1 : 0;
                            positives += frame.positive ? 1 : 0;
                            any_positive = any_positive || frame.positive;
                        }
                    const double f1 =
                        2 * true_positives / (found + positives + (found + positives == 0 ? 1 : 0));
                    const bool stricter = upper ? epsilon < expected : epsilon > expected;
                    if (f1 > best || (f1 == best && f1 > 0 && stricter)) {
                        best = f1;
                        expected = epsilon;
                    }
                }
            }
            const auto fit = fit_misses(model.predicates[0], evidence(episodes, upper));
            if (best == 0) {
                ASSERT_EQ(std::get<Refusal>(fit),
                          any_positive ? Refusal::no_f1 : Refusal::no_positives);
                continue;
            }
            const auto& fitted = std::get<Fitted>(fit);
            ASSERT_DOUBLE_EQ(fitted.f1, best);
            ASSERT_EQ(fitted.n, frames);
            const auto next = next_observed(comparison, expected, episodes);
            std::vector<double> scores{static_cast<double>(expected)};
            if (next) scores.push_back(static_cast<double>(*next));
            std::sort(scores.begin(), scores.end());
            ASSERT_EQ(fitted.scores, scores) << comparison << " " << n;
            ASSERT_EQ(fitted.epsilon,
                      next ? static_cast<float>((scores[0] + scores[1]) / 2) : expected);
            for (const Episode& episode : episodes)
                for (const Frame& frame : episode)
                    ASSERT_EQ(holds(comparison, frame.delta, fitted.epsilon),
                              holds(comparison, frame.delta, expected));
        }
    }
}

TEST(Fitted, F1IsHalfwayToTheNextValue) {
    const auto fit = [](const std::string& comparison, const Episode& frames) {
        const auto model = model_of(comparison, "calibrated(f1)");
        return std::get<Fitted>(
            fit_misses(model.predicates[0], evidence({frames}, comparison[0] == '<')));
    };
    const Episode apart{{1, true}, {1.5F, true}, {9, false}, {9.5F, false}};
    EXPECT_EQ(fit("<=", apart).epsilon, 5.25F);
    EXPECT_EQ(fit("<=", apart).scores, (std::vector<double>{1.5, 9}));
    EXPECT_EQ(fit(">=", {{-1, true}, {-1.5F, true}, {-9, false}}).epsilon, -5.25F);
    EXPECT_EQ(fit(">=", {{-1, true}, {-1.5F, true}, {-9, false}}).scores,
              (std::vector<double>{-9, -1.5}));
    EXPECT_EQ(fit("<", apart).epsilon, 5.25F);  // 9 accepts the same frames as 5.25
    EXPECT_EQ(fit(">", {{-1, true}, {-1.5F, true}, {-9, false}}).epsilon, -5.25F);
    // Nothing beyond, or nothing finite: the observed value.
    EXPECT_EQ(fit("<=", {{1, true}, {1.5F, true}}).epsilon, 1.5F);
    EXPECT_EQ(fit("<=", {{1, true}, {kInfinity, false}}).epsilon, 1.0F);
    EXPECT_EQ(fit("<", {{-kInfinity, true}, {1, false}}).epsilon, 1.0F);
    // There is no float32 between neighbours either; between others none of the two is crossed.
    const float next = std::nextafter(1.0F, 2.0F);
    EXPECT_EQ(fit("<=", {{1, true}, {next, false}}).epsilon, 1.0F);
    EXPECT_EQ(fit("<=", {{1, true}, {next, false}}).scores, std::vector<double>{1});
    EXPECT_EQ(fit("<", {{1, true}, {next, false}}).epsilon, next);
    EXPECT_EQ(fit("<=", {{1, true}, {std::nextafter(next, 2.0F), false}}).epsilon, next);
    EXPECT_EQ(fit("<=", {{-FLT_MAX, true}, {FLT_MAX, false}}).epsilon, 0.0F);
    EXPECT_EQ(fit("<=", {{FLT_MAX / 2, true}, {FLT_MAX, false}}).epsilon, FLT_MAX / 4 * 3);
}

TEST(Fitted, InfiniteScoresAreRefused) {
    const auto model = model_of("<=", "calibrated(conformal, alpha = 0.5)");
    const auto fit = [&](float last) {
        return fit_misses(model.predicates[0], evidence({{{1, true}}, {{last, true}}}, true));
    };
    EXPECT_EQ(std::get<Refusal>(fit(kInfinity)), Refusal::not_finite);
    EXPECT_EQ(std::get<Refusal>(fit(FLT_MAX)), Refusal::not_finite);  // no float32 beyond it
    EXPECT_EQ(std::get<Fitted>(fit(1)).k, 2U);
    EXPECT_EQ(std::get<Fitted>(fit(-kInfinity)).epsilon, std::nextafter(1.0F, 2.0F));
}

/// The thresholds file is the same for any number of threads.
TEST(Calibrate, ThreadsDoNotChangeTheResult) {
    Random random(43);
    std::vector<std::unique_ptr<TemporaryPath>> files;
    calibrate::Request request;
    request.version = "test";
    for (int episode = 0; episode < 30; ++episode) {
        std::string text = "x,y\n";
        for (int t = 0; t < 20; ++t)
            text += fmt::format("{},{}\n", random.uniform(), random.between(0, 1));
        files.push_back(
            std::make_unique<TemporaryPath>(fmt::format("episode{}.csv", episode), text));
        request.episodes.push_back(files.back()->path());
    }
    for (const std::string method :
         {"f1", "conformal, alpha = 0.1", "class_conditional, alpha = 0.1",
          "adaptive, alpha = 0.1, gamma = 0.1, lo = 0, hi = 2"}) {
        const auto model = model_of("<", fmt::format("calibrated({})", method));
        std::string first;
        for (const unsigned jobs : {1U, 2U, 5U, 64U}) {
            request.jobs = jobs;
            std::size_t reports = 0;
            request.progress = [&](std::size_t done, std::size_t total) {
                ++reports;
                EXPECT_EQ(done, reports);
                EXPECT_EQ(total, 30U);
            };
            diag::Sink sink;
            const auto result = calibrate::calibrate(model, request, sink);
            ASSERT_TRUE(result);
            const std::string written = thresholds::write(result->file) + result->report;
            if (first.empty()) first = written;
            EXPECT_EQ(written, first) << jobs;
            EXPECT_EQ(reports, 30U);
        }
    }
}

}  // namespace
}  // namespace etlc::tests
