// Checks entries of the thresholds file against themselves: each contradiction names its key, the
// value found and the value expected.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "check/guarantees/conformal.hpp"

namespace etlc::check {
namespace {

using thresholds::Entry;

std::vector<std::uint64_t> episodes(std::size_t count) {
    std::vector<std::uint64_t> result(count);
    std::iota(result.begin(), result.end(), std::uint64_t{0x10});
    return result;
}

/// An entry from nine scores at alpha = 0.2; the threshold is above the eighth.
Entry conformal(bool upper_bound) {
    Entry entry;
    entry.method = "conformal";
    entry.alpha = "0.20";
    entry.n = 9;
    entry.k = 8;
    entry.scores = {0.5, 1, 1, 1.5, 2, 2.25, 2.5, 3, 4};
    entry.epsilon = beyond(upper_bound ? 3 : 1, upper_bound);
    return entry;
}

Entry pooled(const std::string& method) {
    Entry entry = conformal(true);
    entry.method = method;
    entry.scores = {0.25};
    entry.epsilon = method == "f1" ? 0.25F : beyond(0.25, true);
    if (method == "f1") entry.k = 0;
    return entry;
}

/// Returns the message about the entry after the change; empty if it is accepted.
std::string said(Entry entry, const std::function<void(Entry&)>& change, bool upper_bound = true,
                 const std::vector<std::uint64_t>& of = episodes(10)) {
    change(entry);
    const auto found = contradiction(entry, "predicates.p", upper_bound, of, {});
    return found ? found->message : "";
}

TEST(Consistency, WhatCalibrationWritesIsBelieved) {
    for (const bool upper : {false, true})
        EXPECT_EQ(said(
                      conformal(upper), [](Entry&) {}, upper),
                  "");
    EXPECT_EQ(said(conformal(true), [](Entry& e) { e.method = "adaptive"; }), "");
    EXPECT_EQ(said(conformal(true),
                   [](Entry& e) { e.scores[8] = std::numeric_limits<double>::infinity(); }),
              "");
    for (const std::string method : {"f1", "class_conditional"})
        EXPECT_EQ(said(pooled(method), [](Entry&) {}), "");
}

TEST(Consistency, CountsFollowFromAlphaAndTheScores) {
    const Entry good = conformal(true);
    EXPECT_EQ(said(good, [](Entry& e) { e.k = 1; }),
              "'predicates.p.k' is 1, expected 8: the rank of alpha = 0.2 among 9 scores");
    EXPECT_EQ(said(good, [](Entry& e) { e.n = 10; }),
              "'predicates.p.scores' has 9 elements, expected n of them, which is 10");
    EXPECT_EQ(said(good, [](Entry& e) { e.n = 0; }),
              "'predicates.p.n' is 0, expected a number of scores from 1");
    EXPECT_EQ(said(good, [](Entry& e) { e.alpha = "0.05"; }),
              "'predicates.p.n' is 9, expected at least 19, which alpha = 0.05 needs");
    EXPECT_EQ(said(good, [](Entry& e) { std::swap(e.scores[2], e.scores[3]); }),
              "'predicates.p.scores[3]' is 1, expected at least 1.5, the score before it");
    EXPECT_EQ(said(pooled("class_conditional"), [](Entry& e) { e.n = 100; }),
              "'predicates.p.k' is 8, expected 81: the rank of alpha = 0.2 among 100 scores");
    EXPECT_EQ(said(pooled("class_conditional"),
                   [](Entry& e) { e.n = std::numeric_limits<std::uint64_t>::max(); }),
              "'predicates.p.n' is 18446744073709551615, expected a number of scores from 1");
    EXPECT_EQ(
        said(pooled("f1"), [](Entry& e) { e.scores.clear(); }),
        "'predicates.p.scores' has 0 elements, expected 1 or 2: the chosen score and the next");
    EXPECT_EQ(said(pooled("class_conditional"), [](Entry& e) { e.scores.push_back(9); }),
              "'predicates.p.scores' has 2 elements, expected 1: the chosen score");
}

TEST(Consistency, EpisodesAreThereOnceEach) {
    const Entry good = conformal(true);
    EXPECT_EQ(
        said(
            good, [](Entry&) {}, true, episodes(8)),
        "'episodes' has 8 elements, expected at least 9: one for each score of 'predicates.p'");
    std::vector<std::uint64_t> twice = episodes(10);
    twice[7] = twice[2];
    EXPECT_EQ(
        said(
            good, [](Entry&) {}, true, twice),
        "'episodes[7]' is '0000000000000012', which occurs earlier; expected each episode once");
    EXPECT_EQ(contradiction(good, "monitors.p", true, {}, {})->message,
              "'monitors.p.episodes' has 0 elements, expected at least 9: one for each score of "
              "'monitors.p'");
    EXPECT_EQ(said(pooled("f1"), [](Entry&) {}, true, {}),
              "'episodes' has 0 elements, expected at least 1");
}

TEST(Consistency, TheThresholdIsThatOfItsScore) {
    EXPECT_EQ(
        said(conformal(true), [](Entry& e) { e.epsilon = 0.31F; }),
        "'predicates.p.epsilon' is 0.310000002, expected 3.00000024: the first float32 beyond "
        "'predicates.p.scores[7]', 3");
    EXPECT_EQ(said(
                  conformal(false), [](Entry& e) { e.epsilon = 1; }, false),
              "'predicates.p.epsilon' is 1, expected 0.99999994: the first float32 beyond "
              "'predicates.p.scores[1]', 1");
    EXPECT_EQ(
        said(pooled("f1"), [](Entry& e) { e.epsilon = 0.5F; }),
        "'predicates.p.epsilon' is 0.5, expected 0.25: that is 'predicates.p.scores[0]', 0.25");
    Entry halfway = pooled("f1");
    halfway.scores = {0.25, 0.75};
    halfway.epsilon = 0.5F;
    EXPECT_EQ(said(halfway, [](Entry&) {}), "");
    EXPECT_EQ(said(halfway, [](Entry& e) { e.epsilon = 0.25F; }),
              "'predicates.p.epsilon' is 0.25, expected 0.5: halfway between the two "
              "'predicates.p.scores', 0.25 and 0.75");
    for (const bool upper : {false, true}) {
        Entry infinite = conformal(upper);
        infinite.scores.assign(9, upper ? INFINITY : -INFINITY);
        EXPECT_NE(said(
                      infinite, [](Entry&) {}, upper),
                  "");
        for (const float toward :
             {-INFINITY, INFINITY})  // the next float32 on either side is another threshold
            EXPECT_NE(said(
                          conformal(upper),
                          [&](Entry& e) { e.epsilon = std::nextafter(e.epsilon, toward); }, upper),
                      "");
    }
}

/// Two sides at alpha = 0.2 and beta = 0.1 of `<=` (or `>=`): the positive frames lie up to 3 (from
/// 3 on), the negative ones from 2 on (up to 2).
Entry of_both(bool upper_bound) {
    const double sign = upper_bound ? 1 : -1;
    Entry entry = conformal(upper_bound);
    if (!upper_bound) entry.scores = {-4, -3, -2.5, -2.25, -2, -1.5, -1, -1, -0.5};
    entry.epsilon = beyond(3 * sign, upper_bound);
    entry.against = "both";
    entry.beta = "0.1";
    thresholds::Side& inner = entry.inner.emplace();
    inner.n = 9;
    inner.k = 9;
    inner.scores.assign(9, 5 * sign);
    inner.scores[upper_bound ? 0 : 8] = 2 * sign;
    inner.epsilon = beyond(2 * sign, !upper_bound);
    return entry;
}

TEST(Consistency, EachOfTwoThresholdsIsThatOfItsScores) {
    for (const bool upper : {false, true}) {
        const Entry good = of_both(upper);
        EXPECT_EQ(said(
                      good, [](Entry&) {}, upper),
                  "");
        EXPECT_EQ(said(
                      good, [](Entry& e) { e.inner->k = 8; }, upper),
                  "'predicates.p.inner.k' is 8, expected 9: the rank of beta = 0.1 among 9 scores");
        EXPECT_NE(said(
                      good, [](Entry& e) { e.inner->epsilon += 0.5F; }, upper),
                  "");
        EXPECT_NE(said(
                      good, [](Entry& e) { std::swap(e.epsilon, e.inner->epsilon); }, upper),
                  "");
        const auto too_few = [&](Entry& e) {
            e.inner->n = 3;
            e.inner->k = 4;
            e.inner->scores.resize(3);
            e.inner->epsilon = upper ? -INFINITY : INFINITY;
        };
        EXPECT_EQ(said(good, too_few, upper), "");
        const auto both_infinite = [&](Entry& e) {
            too_few(e);
            e.n = e.k = 0;
            e.k = 1;
            e.scores.clear();
            e.epsilon = upper ? INFINITY : -INFINITY;
        };
        EXPECT_EQ(
            said(good, both_infinite, upper),
            "both thresholds of 'predicates.p' are infinite, expected one that is finite: the "
            "scores are too few");
        const auto [value, inner] = both(good.epsilon, good.inner->epsilon, upper);
        EXPECT_EQ(value, good.epsilon);
        EXPECT_EQ(inner, good.inner->epsilon);
        // Where the inner one is beyond the outer one, one threshold halfway keeps both bounds.
        const auto separated = both(good.inner->epsilon, good.epsilon, upper);
        EXPECT_FALSE(separated.inner);
        EXPECT_EQ(separated.value, upper ? 2.5F : -2.5F);
    }
    Entry one_sided = conformal(true);
    one_sided.against = "false_positives";
    one_sided.epsilon = beyond(1, false);
    EXPECT_EQ(said(one_sided, [](Entry&) {}), "");
    one_sided.epsilon = beyond(3, true);
    EXPECT_NE(said(one_sided, [](Entry&) {}), "");
}

TEST(Consistency, TheRiskIsThatOfTheLosses) {
    // (sum + 1) / (n + 1) <= alpha
    EXPECT_TRUE(keeps_risk(std::vector<double>(9, 0.0), "0.1"));
    EXPECT_FALSE(keeps_risk(std::vector<double>(8, 0.0), "0.1"));
    EXPECT_TRUE(keeps_risk(std::vector<double>(99, 0.0), "0.01"));
    EXPECT_TRUE(keeps_risk({0.5, 0.25, 0.25, 0, 0, 0, 0, 0, 0}, "0.2"));
    EXPECT_FALSE(keeps_risk({0.5, 0.25, 0.26, 0, 0, 0, 0, 0, 0}, "0.2"));
    EXPECT_FALSE(keeps_risk(std::vector<double>(9, 1.0), "0.9999"));
    Entry entry;
    entry.method = "risk";
    entry.alpha = "0.2";
    entry.n = 9;
    entry.scores = {3};
    entry.epsilon = beyond(3, true);
    entry.losses = {0.5, 0.25, 0.25, 0, 0, 0, 0, 0, 0};
    entry.losses_before = {0.5, 0.5, 0.25, 0, 0, 0, 0, 0, 0};
    EXPECT_EQ(said(entry, [](Entry&) {}), "");
    EXPECT_EQ(
        said(entry, [](Entry& e) { e.losses[3] = 0.5; }),
        "'predicates.p.losses' are too great for alpha = 0.2: expected n / (n + 1) mean + 1 / "
        "(n + 1) of them, which is at most that");
    EXPECT_EQ(
        said(entry, [](Entry& e) { e.losses_before = e.losses; }),
        "'predicates.p.losses_before' are small enough for alpha = 0.2, so that the threshold "
        "would be a tighter one");
    EXPECT_EQ(said(entry, [](Entry& e) { e.losses.pop_back(); }),
              "'predicates.p.losses' has 8 elements, expected 9");
    EXPECT_EQ(said(entry, [](Entry& e) { e.losses[0] = 1.5; }),
              "'predicates.p.losses[0]' is 1.5, expected a share from 0 to 1");
    EXPECT_EQ(said(conformal(true), [](Entry& e) { e.losses = {0.5}; }),
              "'predicates.p.losses' has 1 element, expected 0");
}

}  // namespace
}  // namespace etlc::check
