// Truth values: their algebra, the comparisons that make them, the answers made of them, and lazy
// evaluation, over all combinations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "etlmon/temporal/boolean_verdict.hpp"
#include "etlmon/temporal/boolean_window.hpp"
#include "etlmon/temporal/demand.hpp"
#include "temporal_streams.hpp"

namespace {

using etlmon::kNo;
using etlmon::kPerhaps;
using etlmon::kYes;
using etlmon::Truth;
using temporal::same;

constexpr Truth kAll[] = {kNo, kPerhaps, kYes};

/// Truth as a number: 0, 1/2, 1.
int rank(Truth t) {
    return (t.low ? 1 : 0) + (t.high ? 1 : 0);
}

TEST(TemporalTruth, IsThreeValuedLogic) {
    for (const Truth a : kAll) {
        EXPECT_EQ(rank(etlmon::negate(a)), 2 - rank(a));
        for (const Truth b : kAll) {
            EXPECT_EQ(rank(min_of(a, b)), std::min(rank(a), rank(b)));
            EXPECT_EQ(rank(max_of(a, b)), std::max(rank(a), rank(b)));
        }
    }
}

TEST(TemporalTruth, ComparisonsDecideExactly) {
    const float kNext = std::nextafter(0.5f, 1.0f);
    EXPECT_TRUE(same(etlmon::is_at_most(0.5f, 0.5f), kYes));
    EXPECT_TRUE(same(etlmon::is_below(0.5f, 0.5f), kNo));
    EXPECT_TRUE(same(etlmon::is_at_least(0.5f, 0.5f), kYes));
    EXPECT_TRUE(same(etlmon::is_above(0.5f, 0.5f), kNo));
    EXPECT_TRUE(same(etlmon::is_at_most(kNext, 0.5f), kNo));
    EXPECT_TRUE(same(etlmon::is_below(0.5f, kNext), kYes));
    EXPECT_TRUE(same(etlmon::is_at_least(0.5f, kNext), kNo));
    EXPECT_TRUE(same(etlmon::is_above(kNext, 0.5f), kYes));
    EXPECT_TRUE(same(etlmon::is_at_most(-0.0f, 0.0f), kYes));
    EXPECT_TRUE(same(etlmon::is_below(-0.0f, 0.0f), kNo));
    EXPECT_TRUE(same(etlmon::is_at_most(etlmon::float_of(etlmon::kTop), 3e38f), kNo));
    EXPECT_TRUE(same(etlmon::is_at_most(etlmon::kMissing, 0.5f), kPerhaps));
    EXPECT_TRUE(same(etlmon::is_above(etlmon::kMissing, -1.0f, kYes), kYes));
}

TEST(TemporalTruth, Flags) {
    EXPECT_TRUE(same(etlmon::truth_of(etlmon::Flag(true)), kYes));
    EXPECT_TRUE(same(etlmon::truth_of(etlmon::Flag(false)), kNo));
    EXPECT_TRUE(same(etlmon::truth_of(etlmon::Flag()), kPerhaps));
}

TEST(TemporalTruth, Answers) {
    for (const Truth holds : kAll)
        for (const bool surely : {false, true})
            for (const bool perhaps : {false, true}) {
                const etlmon::BooleanVerdict verdict =
                    etlmon::prefix_verdict(holds, surely, perhaps);
                EXPECT_EQ(verdict.satisfied(), rank(holds) == 2);
                EXPECT_EQ(verdict.violated(), rank(holds) == 0);
                EXPECT_EQ(verdict.unknown(), rank(holds) == 1);
                EXPECT_EQ(verdict.final(), surely || !perhaps);
                EXPECT_TRUE(verdict.decided());
            }
    EXPECT_FALSE(etlmon::BooleanVerdict().decided());
    EXPECT_FALSE(etlmon::BooleanVerdict().unknown());
    EXPECT_TRUE(etlmon::sliding_verdict(kPerhaps).unknown());
    EXPECT_TRUE(etlmon::sliding_verdict(kPerhaps).final());
}

// Asked from left to right, at most once each, and no further than needed.
TEST(TemporalTruth, LazyValuesAreAskedWhereTheyDecide) {
    for (const Truth first : kAll)
        for (const Truth second : kAll)
            for (const bool both : {false, true}) {
                int asked[2] = {0, 0};
                const auto find = [&](int which, Truth value) {
                    ++asked[which];
                    return value;
                };
                const etlmon::Lazy a([&]() noexcept { return find(0, first); });
                const etlmon::Lazy b([&]() noexcept { return find(1, second); });
                const auto combined = both ? Truth(min_of(a, b)) : Truth(max_of(a, b));
                EXPECT_TRUE(same(combined, both ? min_of(first, second) : max_of(first, second)));
                const bool decided = both ? rank(first) == 0 : rank(first) == 2;
                EXPECT_EQ(asked[0], 1);
                EXPECT_EQ(asked[1], decided ? 0 : 1);
                const Truth nested = max_of(min_of(a, negate(b)), min_of(negate(a), b));
                EXPECT_TRUE(same(nested, max_of(min_of(first, etlmon::negate(second)),
                                                min_of(etlmon::negate(first), second))));
                EXPECT_EQ(asked[0], 1);
                EXPECT_LE(asked[1], 1);
            }
}

}  // namespace
