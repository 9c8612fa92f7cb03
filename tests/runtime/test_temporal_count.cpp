// Compares counts with sorted copies of their windows: whether the n-th greatest value, or the n-th
// least, is returned at every step, over pairs of keys, values with samples and truth values.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "etlmon/past/count.hpp"
#include "temporal_streams.hpp"

namespace {

using etlmon::Key;
using etlmon::Sourced;
using temporal::Truth;
using temporal::Value;

/// The n-th greatest, or the n-th least; false or true where there are fewer.
Key nth_by_sorting(std::vector<Key> last, bool max, uint32_t n) {
    if (last.size() < n) return max ? etlmon::kBottom : etlmon::kTop;
    std::sort(last.begin(), last.end());
    return max ? last[last.size() - n] : last[n - 1];
}

Value counted(const std::vector<Value>& all, size_t step, bool max, uint32_t n, uint32_t length) {
    std::vector<Key> lows;
    std::vector<Key> highs;
    for (size_t j = step + 1 < length ? 0 : step + 1 - length; j <= step; ++j) {
        lows.push_back(all[j].low);
        highs.push_back(all[j].high);
    }
    return {nth_by_sorting(lows, max, n), nth_by_sorting(highs, max, n)};
}

Truth truth_of_sign(Value value) {
    return {value.low >= 0, value.high >= 0};
}

Value keys_of(Sourced value) {
    return {value.low.key(), value.high.key()};
}

/// Counts of one kind, reset in the middle of streams.
template <uint32_t n, uint32_t length>
void expect_counts() {
    const auto at_least = std::make_unique<etlmon::AtLeast<Value, n, length>>();
    const auto all_but = std::make_unique<etlmon::AllBut<Value, n, length>>();
    const auto sourced = std::make_unique<etlmon::AtLeast<Sourced, n, length>>();
    const auto truth = std::make_unique<etlmon::AtLeast<Truth, n, length>>();
    const auto truth_but = std::make_unique<etlmon::AllBut<Truth, n, length>>();
    static_assert(sizeof(*at_least) == etlmon::count_bytes<Value>(n, length));
    static_assert(sizeof(*all_but) == etlmon::count_bytes<Value>(n, length));
    static_assert(sizeof(*sourced) == etlmon::count_bytes<Sourced>(n, length));
    static_assert(sizeof(*truth) == etlmon::count_bytes<Truth>(n, length));
    for (uint32_t round = 0; round < 4; ++round) {
        at_least->reset();
        all_but->reset();
        sourced->reset();
        truth->reset();
        truth_but->reset();
        const auto all = temporal::random_streams<Value>((round + 1) * length + 9, round).g;
        for (size_t i = 0; i < all.size(); ++i) {
            const Value greatest = counted(all, i, true, n, length);
            const Value least = counted(all, i, false, n, length);
            ASSERT_TRUE(temporal::same(at_least->push(all[i]), greatest)) << n << ' ' << i;
            ASSERT_TRUE(temporal::same(all_but->push(all[i]), least)) << n << ' ' << i;
            ASSERT_TRUE(temporal::same(keys_of(sourced->push(all[i])), greatest)) << n << ' ' << i;
            const Truth sign = truth_of_sign(all[i]);
            ASSERT_TRUE(temporal::same(truth->push(sign), truth_of_sign(greatest))) << i;
            ASSERT_TRUE(temporal::same(truth_but->push(sign), truth_of_sign(least))) << i;
        }
    }
}

TEST(TemporalCount, IsThatOfTheSortedWindow) {
    expect_counts<1, 1>();
    expect_counts<1, 6>();
    expect_counts<2, 2>();
    expect_counts<2, 3>();
    expect_counts<3, 4>();
    expect_counts<3, 61>();
    expect_counts<5, 100>();
    expect_counts<20, 40>();
    // Longer ones than 64 n keep the n greatest.
    expect_counts<1, 65>();
    expect_counts<2, 129>();
    expect_counts<120, 150>();
    expect_counts<150, 150>();
}

TEST(TemporalCount, IsFalseWithFewerStepsThanItAsksFor) {
    etlmon::AtLeast<Value, 4, 3> never;
    etlmon::AllBut<Value, 4, 3> always;
    never.reset();
    always.reset();
    for (int i = 0; i < 9; ++i) {
        EXPECT_TRUE(temporal::same(never.push(etlmon::kTrue), etlmon::kFalse));
        EXPECT_TRUE(temporal::same(always.push(etlmon::kFalse), etlmon::kTrue));
    }
}

}  // namespace
