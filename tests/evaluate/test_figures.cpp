// Compares rates, AUROC and intervals with their definitions, computed the slow way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "episodes/bootstrap.hpp"
#include "evaluate/figures.hpp"
#include "evaluate/outcomes.hpp"

namespace etlc::evaluate {
namespace {

using Pairs = std::vector<std::pair<Label, Label>>;  // predicted, actual

Pairs random_pairs(std::mt19937& random, bool unknowns) {
    Pairs pairs(1 + random() % 30);
    for (auto& [predicted, actual] : pairs) {
        const auto draw = [&] {
            const std::uint64_t x = random() % (unknowns ? 5 : 4);
            return x == 4 ? Label::unknown : x % 2 == 0 ? Label::yes : Label::no;
        };
        predicted = draw();
        actual = draw();
    }
    return pairs;
}

std::optional<double> share(const Pairs& pairs, auto of, auto what) {
    double whole = 0;
    double part = 0;
    for (const auto& [predicted, actual] : pairs) {
        if (actual == Label::unknown || !of(predicted, actual)) continue;
        whole += 1;
        part += what(predicted, actual) ? 1 : 0;
    }
    if (whole == 0) return std::nullopt;
    return part / whole;
}

void expect_near(const std::optional<double>& found, const std::optional<double>& expected) {
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (found) {
        EXPECT_NEAR(*found, *expected, 1e-12);
    }
}

TEST(Rates, AreTheSharesThatTheirNamesSay) {
    std::mt19937 random(1);
    const auto any = [](Label, Label) { return true; };
    const auto is_positive = [](Label predicted, Label) { return predicted == Label::yes; };
    const auto positive = [](Label, Label actual) { return actual == Label::yes; };
    const auto agree = [](Label predicted, Label actual) { return predicted == actual; };
    for (int round = 0; round < 2000; ++round) {
        const Pairs pairs = random_pairs(random, round % 2 == 0);
        Counts counts;
        for (const auto& [predicted, actual] : pairs) counts.add(predicted, actual);
        const Rates found = rates(counts);
        const auto precision = share(pairs, is_positive, agree);
        const auto recall = share(pairs, positive, agree);
        expect_near(found.precision, precision);
        expect_near(found.recall, recall);
        expect_near(found.agreement, share(pairs, any, agree));
        const auto negative = [](Label, Label actual) { return actual == Label::no; };
        const auto unknown = [](Label predicted, Label) { return predicted == Label::unknown; };
        const auto decided = [](Label predicted, Label) { return predicted != Label::unknown; };
        const auto wrong = [&](Label predicted, Label actual) {
            return decided(predicted, actual) && predicted != actual;
        };
        expect_near(found.unknown, share(pairs, any, unknown));
        expect_near(found.wrong_when_decided, share(pairs, decided, wrong));
        expect_near(found.false_negative_rate, share(pairs, positive, wrong));
        expect_near(found.false_positive_rate, share(pairs, negative, wrong));
        // F1 is the harmonic mean of the two, or 0 if both are 0.
        if (precision && recall)
            expect_near(found.f1, *precision + *recall == 0
                                      ? 0
                                      : 2 * *precision * *recall / (*precision + *recall));
        else
            expect_near(found.f1, precision || recall ? std::optional(0.0) : std::nullopt);
        Counts thrice;
        thrice.add(counts, 3);
        expect_near(rates(thrice).f1, found.f1);
    }
}

TEST(Rates, OfConstantPredictions) {
    std::mt19937 random(2);
    for (int round = 0; round < 500; ++round) {
        const Pairs pairs = random_pairs(random, false);
        for (const Label prediction : {Label::yes, Label::no}) {
            Counts counts;
            for (const auto& pair : pairs) counts.add(prediction, pair.second);
            const Rates blind =
                rates_of_constant(prediction == Label::yes, counts.positives(), counts.total());
            expect_near(blind.f1, rates(counts).f1);
            expect_near(blind.precision, rates(counts).precision);
            expect_near(blind.recall, rates(counts).recall);
            expect_near(blind.agreement, rates(counts).agreement);
        }
    }
}

using Drawn = std::vector<std::uint32_t>;  ///< counts per episode

std::vector<Drawn> resamples_of(std::size_t episodes) {
    std::vector<Drawn> all;
    Bootstrap(episodes).for_each_batch([&](const Weights& weights) {
        for (std::size_t r = 0; r < weights.resamples(); ++r) {
            all.emplace_back();
            for (std::size_t e = 0; e < episodes; ++e) all.back().push_back(weights[e][r]);
        }
    });
    return all;
}

TEST(Bootstrap, DrawsEpisodesWithReplacement) {
    const auto resamples = resamples_of(50);
    ASSERT_EQ(resamples.size(), kResamples);
    std::vector<double> drawn(50);
    for (const Drawn& weights : resamples) {
        EXPECT_EQ(std::accumulate(weights.begin(), weights.end(), 0U), 50U);
        for (std::size_t e = 0; e < 50; ++e) drawn[e] += weights[e];
    }
    for (const double times : drawn) EXPECT_NEAR(times, kResamples, 6 * std::sqrt(kResamples));
    EXPECT_EQ(resamples, resamples_of(50));
    // The first draws, so that tables made elsewhere are equal.
    EXPECT_EQ(resamples_of(3)[0], (Drawn{0, 1, 2}));
}

/// The draws form one sequence, however many are made at a time.
TEST(Bootstrap, MakesManyEpisodesBatchByBatch) {
    constexpr std::size_t kMany = 10'000;
    std::size_t batches = 0;
    episodes::Random random(2026);
    Bootstrap(kMany).for_each_batch([&](const Weights& weights) {
        ++batches;
        for (std::size_t r = 0; r < weights.resamples(); ++r) {
            Drawn expected(kMany);
            for (std::size_t i = 0; i < kMany; ++i) ++expected[random.below(kMany)];
            for (std::size_t e = 0; e < kMany; ++e) ASSERT_EQ(weights[e][r], expected[e]);
        }
    });
    EXPECT_GT(batches, 1U);
}

TEST(Rates, OfResamplesAreThoseOfTheSums) {
    std::mt19937 random(8);
    constexpr std::size_t kEpisodes = 7;
    std::vector<Counts> each(kEpisodes);
    Weights weights(kEpisodes, 5, 0);
    for (std::size_t e = 0; e < kEpisodes; ++e) {
        each[e] = {random() % 5, random() % 5, random() % 5, random() % 5,
                   random() % 3, random() % 3, random() % 3};
        for (std::size_t r = 0; r < 5; ++r)
            weights[e][r] = static_cast<Weights::Weight>(r == 0 ? 0 : random() % 4);
    }
    const std::vector<Rates> found = rates(each, weights);
    for (std::size_t r = 0; r < 5; ++r) {
        Counts sum;
        for (std::size_t e = 0; e < kEpisodes; ++e) sum.add(each[e], weights[e][r]);
        const Rates expected = rates(sum);
        EXPECT_EQ(found[r].f1, expected.f1);
        EXPECT_EQ(found[r].precision, expected.precision);
        EXPECT_EQ(found[r].recall, expected.recall);
        EXPECT_EQ(found[r].agreement, expected.agreement);
    }
    EXPECT_FALSE(found[0].agreement) << "nothing counts";
}

TEST(Bootstrap, IntervalsCoverAMean) {
    // Of 200 samples of 40 numbers, about 95 % have an interval that contains the true mean; 90 %
    // is a safe lower limit.
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0, 1);
    const Bootstrap bootstrap(40);
    int covered = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<double> values(40);
        for (double& value : values) value = uniform(random);
        const Figure figure = bootstrap.figure([&](const Weights& weights) {
            std::vector<std::optional<double>> means(weights.resamples(), 0);
            for (std::size_t i = 0; i < values.size(); ++i)
                for (std::size_t r = 0; r < means.size(); ++r)
                    *means[r] += weights[i][r] * values[i] / 40;
            return means;
        });
        ASSERT_TRUE(figure.value && figure.interval);
        EXPECT_LE(figure.interval->low, *figure.value);
        EXPECT_GE(figure.interval->high, *figure.value);
        covered += figure.interval->low <= 0.5 && 0.5 <= figure.interval->high ? 1 : 0;
    }
    EXPECT_GE(covered, 175);
    EXPECT_LE(covered, 199);
}

TEST(Bootstrap, QuantilesAreThoseOfTheValuesThatAreThere) {
    std::vector<std::optional<double>> values;
    for (int i = 1000; i >= 0; --i) values.emplace_back(i);
    EXPECT_EQ(percentile_interval(values)->low, 25);
    EXPECT_EQ(percentile_interval(values)->high, 975);
    values.resize(1900);  // most of them
    EXPECT_EQ(percentile_interval(values)->low, 25);
    values.resize(2100);
    EXPECT_FALSE(percentile_interval(values));
    EXPECT_FALSE(percentile_interval({}));
}

TEST(Bootstrap, OfOneEpisodeHasNoInterval) {
    const auto one = [](const Weights& weights) {
        return std::vector<std::optional<double>>(weights.resamples(), 1.0);
    };
    EXPECT_FALSE(Bootstrap(1).figure(one).interval);
    EXPECT_TRUE(Bootstrap(2).figure(one).interval);
}

// ---- outcomes -----------------------------------------------------------------------------------

using Kind = episodes::Outcome::Kind;

std::vector<Judged> random_episodes(std::mt19937& random) {
    std::vector<Judged> episodes(1 + random() % 30);
    const std::uint32_t folds = 1 + random() % 2;
    for (Judged& one : episodes) {
        one.outcome.kind = static_cast<Kind>(random() % 8 < 6 ? 2 + random() % 2 : random() % 2);
        one.frames = 3 + random() % 6;
        if (one.failed() && random() % 3 == 0) one.outcome.failed_at = 1 + random() % one.frames;
        one.fold = static_cast<std::uint32_t>(random() % folds);
        if (random() % 2 == 0) one.alarm = random() % one.frames;
        one.least_upper = static_cast<float>(random() % 5) - 2;
        if (random() % 8 == 0) one.least_upper = std::numeric_limits<float>::infinity();
    }
    return episodes;
}

std::optional<double> balanced(const std::vector<Judged>& episodes, auto has_alarm) {
    double of[2][2] = {};
    for (std::size_t e = 0; e < episodes.size(); ++e)
        if (episodes[e].failed() || episodes[e].succeeded())
            of[episodes[e].failed()][has_alarm(e)] += 1;
    if (of[0][0] + of[0][1] == 0 || of[1][0] + of[1][1] == 0) return std::nullopt;
    return (of[0][0] / (of[0][0] + of[0][1]) + of[1][1] / (of[1][0] + of[1][1])) / 2;
}

/// Tries all pairs of lengths on all other episodes. Of equals the rule that a scan finds first:
/// the least last length, then the greatest first one.
bool alarm_by_duration(const std::vector<Judged>& episodes, std::size_t judged) {
    std::vector<Judged> others = episodes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(judged));
    double best = balanced(others, [](std::size_t) { return false; }).value_or(1);
    bool alarm = false;
    for (std::uint64_t last = 0; last < 12; ++last)
        for (std::uint64_t first = last + 1; first-- > 0;) {
            const auto within = [&](const Judged& one) {
                return first <= one.frames && one.frames <= last;
            };
            const auto here = balanced(others, [&](std::size_t e) { return within(others[e]); });
            if (!here || *here <= best + 1e-9) continue;
            best = *here;
            alarm = within(episodes[judged]);
        }
    return alarm;
}

TEST(Outcomes, AreTheSharesThatTheirNamesSay) {
    std::mt19937 random(3);
    int judged_by_duration = 0;
    for (int round = 0; round < 1000; ++round) {
        const std::vector<Judged> episodes = random_episodes(random);
        const auto found = outcome_score(Bootstrap(episodes.size()), episodes, false);
        std::vector<std::int64_t> warnings;
        std::uint64_t successes = 0;
        std::uint64_t failures = 0;
        double pairs = 0;
        double ordered = 0;
        for (const Judged& one : episodes) {
            successes += one.succeeded() ? 1 : 0;
            failures += one.failed() ? 1 : 0;
            if (!one.failed()) continue;
            if (one.alarm)
                warnings.push_back(static_cast<std::int64_t>(one.outcome.failed_at > 0
                                                                 ? one.outcome.failed_at
                                                                 : one.frames - 1) -
                                   static_cast<std::int64_t>(*one.alarm));
            for (const Judged& other : episodes) {
                if (!other.succeeded() || other.fold != one.fold) continue;
                pairs += 1;
                ordered += one.least_upper < other.least_upper    ? 1
                           : one.least_upper == other.least_upper ? 0.5
                                                                  : 0;
            }
        }
        ASSERT_EQ(found.has_value(), successes + failures > 0);
        if (!found) continue;
        EXPECT_EQ(found->successes, successes);
        EXPECT_EQ(found->failures, failures);
        EXPECT_EQ(found->detected_count, warnings.size());
        expect_near(found->balanced_accuracy.value, balanced(episodes, [&](std::size_t e) {
                        return episodes[e].alarm.has_value();
                    }));
        expect_near(found->auroc.value, pairs > 0 ? std::optional(ordered / pairs) : std::nullopt);
        std::sort(warnings.begin(), warnings.end());
        const Figure* const quartiles[] = {&found->warning_lower_quartile, &found->warning_median,
                                           &found->warning_upper_quartile};
        for (std::size_t q = 0; q < 3; ++q)
            expect_near(quartiles[q]->value,
                        warnings.empty() ? std::nullopt
                                         : std::optional(static_cast<double>(
                                               warnings[((q + 1) * warnings.size() + 3) / 4 - 1])));
        const std::vector<bool> by_duration = alarms_by_duration(episodes);
        for (std::size_t e = 0; e < episodes.size(); ++e) {
            const bool counts = episodes[e].failed() || episodes[e].succeeded();
            EXPECT_EQ(by_duration[e], counts && alarm_by_duration(episodes, e))
                << "round " << round << ", episode " << e;
            judged_by_duration += by_duration[e] ? 1 : 0;
        }
    }
    EXPECT_GT(judged_by_duration, 1000);
}

TEST(Outcomes, WilsonsInterval) {
    // Agresti and Coull, "Approximate is better than exact for interval estimation", 1998.
    EXPECT_NEAR(wilson(5, 10).low, 0.2366, 5e-5);
    EXPECT_NEAR(wilson(5, 10).high, 0.7634, 5e-5);
    EXPECT_EQ(wilson(0, 10).low, 0);
    EXPECT_NEAR(wilson(0, 10).high, 0.2775, 5e-5);
    EXPECT_NEAR(wilson(10, 10).low, 0.7225, 5e-5);
    EXPECT_EQ(wilson(10, 10).high, 1);
}

}  // namespace
}  // namespace etlc::evaluate
