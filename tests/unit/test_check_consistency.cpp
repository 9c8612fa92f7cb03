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
    EXPECT_EQ(said(good, [](Entry& e) { e.against = "missed_alarm"; }, true, {}),
              "'predicates.p.episodes' has 0 elements, expected at least 9: one for each score of "
              "'predicates.p'");
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

}  // namespace
}  // namespace etlc::check
