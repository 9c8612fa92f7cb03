// Tests truth values: their algebra, comparisons, verdicts and lazy evaluation, over all
// combinations; and windows over them, on every short stream.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

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

/// Returns a truth value as a number: 0, 1/2, 1.
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
                const bool final = surely || !perhaps;
                EXPECT_EQ(verdict.final(), final);
                EXPECT_EQ(verdict.open(), !final);
                EXPECT_EQ(verdict.alarm(), final && rank(holds) == 0);
                EXPECT_EQ(verdict.fulfilled(), final && rank(holds) == 2);
                EXPECT_TRUE(verdict.decided());
            }
    EXPECT_FALSE(etlmon::BooleanVerdict().decided());
    EXPECT_FALSE(etlmon::BooleanVerdict().unknown());
    EXPECT_TRUE(etlmon::sliding_verdict(kPerhaps).unknown());
    EXPECT_TRUE(etlmon::sliding_verdict(kPerhaps).final());
}

// Operands are evaluated from left to right, at most once each, and only as far as needed.
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

/// Runs every stream of `length` pairs of these values through a window over the last N.
template <class Case, uint32_t N>
void expect_every_stream(const std::vector<Truth>& values, size_t length) {
    temporal::Streams<Truth> streams{std::vector<Truth>(length), std::vector<Truth>(length)};
    std::vector<size_t> digits(2 * length, 0);
    etlmon::Window<typename Case::Monoid, N> window;
    for (bool more = true; more;) {
        for (size_t i = 0; i < length; ++i) {
            streams.g[i] = values[digits[i]];
            streams.f[i] = values[digits[length + i]];
        }
        window.reset();
        for (size_t i = 0; i < length; ++i) {
            const Truth value = Case::result(window.push(Case::element(streams, i)));
            const size_t first = i + 1 < N ? 0 : i + 1 - N;
            ASSERT_TRUE(same(value, Case::defined(streams, first, i)))
                << Case::kName << ", N " << N << ", step " << i;
        }
        more = false;
        for (size_t& digit : digits) {
            if (++digit < values.size()) {
                more = true;
                break;
            }
            digit = 0;
        }
    }
}

template <class Case, uint32_t... N>
void expect_every_stream(std::integer_sequence<uint32_t, N...>) {
    const std::vector<Truth> all(kAll, kAll + 3);
    (expect_every_stream<Case, N + 1>(all, 5), ...);
    (expect_every_stream<Case, N + 1>({kNo, kYes}, 8), ...);
}

TEST(TemporalTruth, WindowsOnEveryStream) {
    constexpr std::make_integer_sequence<uint32_t, 7> kLengths;
    expect_every_stream<temporal::SinceCase<Truth>>(kLengths);
    expect_every_stream<temporal::UntilCase<Truth>>(kLengths);
    expect_every_stream<temporal::ReleaseCase<Truth>>(kLengths);
}

/// Long enough to wrap around several times, over words of bits.
template <class Case, uint32_t N>
void expect_long_streams(unsigned rarity) {
    const auto window = std::make_unique<etlmon::Window<typename Case::Monoid, N>>();
    window->reset();
    std::mt19937 random(N + rarity);
    temporal::Streams<Truth> streams;
    for (size_t i = 0; i < 6 * N + 50; ++i) {
        // Runs of about that length in which f holds and g does not.
        const bool decides = random() % rarity == 0;
        streams.g.push_back(decides ? kAll[random() % 3] : kNo);
        streams.f.push_back(decides ? kAll[random() % 3] : kYes);
        const Truth value = Case::result(window->push(Case::element(streams, i)));
        const size_t first = i + 1 < N ? 0 : i + 1 - N;
        ASSERT_TRUE(same(value, Case::defined(streams, first, i)))
            << Case::kName << ", N " << N << ", step " << i << ", one in " << rarity;
    }
}

TEST(TemporalTruth, LongWindows) {
    for (const unsigned rarity : {1u, 5u, 31u, 64u, 200u, 1000u}) {
        expect_long_streams<temporal::UntilCase<Truth>, 31>(rarity);
        expect_long_streams<temporal::UntilCase<Truth>, 32>(rarity);
        expect_long_streams<temporal::UntilCase<Truth>, 33>(rarity);
        expect_long_streams<temporal::UntilCase<Truth>, 64>(rarity);
        expect_long_streams<temporal::ReleaseCase<Truth>, 200>(rarity);
        expect_long_streams<temporal::UntilCase<Truth>, 1000>(rarity);
    }
}

}  // namespace
