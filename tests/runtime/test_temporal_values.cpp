// Keys, values and verdicts: order and round trip over every kind of float, classification of every
// kind of verdict. Written without a float comparison, so that it means the same under -ffast-math
// and with denormals flushed.
#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>
#include <vector>

#include "etlmon/temporal/predicate.hpp"
#include "etlmon/temporal/reading.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "temporal_streams.hpp"

namespace {

using etlmon::Key;
using etlmon::Value;
using etlmon::Verdict;

constexpr uint32_t kSignBit = 0x80000000u;

/// Bit patterns of floats from -inf to +inf, ascending, one zero: every exponent, with its first,
/// second, middle and last mantissas.
std::vector<uint32_t> ascending_floats() {
    std::vector<uint32_t> magnitudes;
    for (uint32_t exponent = 0; exponent < 255; ++exponent)
        for (const uint32_t mantissa :
             {0x0u, 0x1u, 0x2u, 0x3fffffu, 0x400000u, 0x400001u, 0x7ffffeu, 0x7fffffu})
            magnitudes.push_back(exponent << 23 | mantissa);
    magnitudes.push_back(0x7f800000u);
    std::vector<uint32_t> ascending;
    for (size_t i = magnitudes.size(); i-- > 1;) ascending.push_back(magnitudes[i] | kSignBit);
    ascending.insert(ascending.end(), magnitudes.begin(), magnitudes.end());
    return ascending;
}

Key key_of_bits(uint32_t bits) {
    return etlmon::key_of(etlmon::float_of_bits(bits));
}

TEST(TemporalKey, OrderIsTheOrderOfTheFloats) {
    const std::vector<uint32_t> floats = ascending_floats();
    for (size_t i = 1; i < floats.size(); ++i)
        ASSERT_LT(key_of_bits(floats[i - 1]), key_of_bits(floats[i]))
            << std::hex << floats[i - 1] << ' ' << floats[i];
}

#ifndef __FAST_MATH__
TEST(TemporalKey, OrderIsWhatTheProcessorCompares) {
    const std::vector<uint32_t> floats = ascending_floats();
    for (size_t i = 0; i < floats.size(); i += 7) {
        for (const uint32_t other : floats) {
            const float a = etlmon::float_of_bits(floats[i]);
            const float b = etlmon::float_of_bits(other);
            ASSERT_EQ(a < b, etlmon::key_of(a) < etlmon::key_of(b)) << a << ' ' << b;
        }
    }
}
#endif

TEST(TemporalKey, RoundTripsToTheSameBits) {
    for (const uint32_t bits : ascending_floats())
        ASSERT_EQ(etlmon::bits_of(etlmon::float_of(key_of_bits(bits))), bits) << std::hex << bits;
}

TEST(TemporalKey, ZerosShareAKey) {
    EXPECT_EQ(key_of_bits(0), 0);
    EXPECT_EQ(key_of_bits(kSignBit), 0);
    EXPECT_EQ(etlmon::bits_of(etlmon::float_of(0)), 0u);
}

TEST(TemporalKey, InfinitiesAreTheLatticeEnds) {
    EXPECT_EQ(key_of_bits(0x7f800000u), etlmon::kTop);
    EXPECT_EQ(key_of_bits(0xff800000u), etlmon::kBottom);
}

TEST(TemporalKey, NegatingAKeyNegatesTheFloat) {
    for (const uint32_t bits : ascending_floats())
        ASSERT_EQ(-key_of_bits(bits), key_of_bits(bits ^ kSignBit));
}

TEST(TemporalValue, MinAndMaxPickTheSmallerAndTheGreaterFloat) {
    const std::vector<uint32_t> floats = ascending_floats();
    for (size_t i = 0; i < floats.size(); i += 13) {
        for (size_t j = 0; j < floats.size(); j += 5) {
            const float a = etlmon::float_of_bits(floats[i]);
            const float b = etlmon::float_of_bits(floats[j]);
            const uint32_t low = floats[i < j ? i : j];
            const uint32_t high = floats[i < j ? j : i];
            ASSERT_EQ(etlmon::bits_of(etlmon::min_of(a, b)), low);
            ASSERT_EQ(etlmon::bits_of(etlmon::max_of(a, b)), high);
            ASSERT_EQ(etlmon::min_of(etlmon::key_of(a), etlmon::key_of(b)), key_of_bits(low));
            ASSERT_EQ(etlmon::max_of(etlmon::key_of(a), etlmon::key_of(b)), key_of_bits(high));
        }
    }
}

TEST(TemporalValue, PairsCombineEndByEnd) {
    std::mt19937 random(7);
    for (int round = 0; round < 10000; ++round) {
        const Value a = temporal::random_value<Value>(random);
        const Value b = temporal::random_value<Value>(random);
        const Value least = min_of(a, b);
        const Value greatest = max_of(a, b);
        ASSERT_EQ(least.low, etlmon::min_of(a.low, b.low));
        ASSERT_EQ(least.high, etlmon::min_of(a.high, b.high));
        ASSERT_EQ(greatest.low, etlmon::max_of(a.low, b.low));
        ASSERT_EQ(greatest.high, etlmon::max_of(a.high, b.high));
        ASSERT_LE(least.low, least.high);
        ASSERT_LE(greatest.low, greatest.high);
        ASSERT_TRUE(temporal::same(negate(min_of(a, b)), max_of(negate(a), negate(b))));
        ASSERT_TRUE(temporal::same(negate(negate(a)), a));
    }
}

TEST(TemporalValue, Between) {
    for (const uint32_t bits : ascending_floats()) {
        const float x = etlmon::float_of_bits(bits);
        ASSERT_TRUE(temporal::same(etlmon::between(x, etlmon::float_of(etlmon::kTop)),
                                   {etlmon::key_of(x), etlmon::kTop}));
    }
}

/// What a compiler that sees a zero leaves out is what a subtraction of one gives.
TEST(TemporalValue, ThresholdsOfZero) {
    volatile float zero = 0.0f;
    for (const uint32_t bits : ascending_floats()) {
        const float delta = etlmon::float_of_bits(bits);
        const bool denormal = (bits & 0x7f800000u) == 0 && (bits << 1) != 0;
        if (denormal || !etlmon::is_finite(delta))
            continue;  // some tests run where differences of these are flushed
        const float unseen = zero;
        ASSERT_TRUE(temporal::same(etlmon::at_least(delta, 0.0f, etlmon::kTrue),
                                   etlmon::at_least(delta, unseen, etlmon::kTrue)));
        ASSERT_TRUE(temporal::same(etlmon::at_most(delta, 0.0f, etlmon::kTrue),
                                   etlmon::at_most(delta, unseen, etlmon::kTrue)));
        ASSERT_TRUE(temporal::same(etlmon::at_least(delta, -0.0f, etlmon::kTrue),
                                   etlmon::between(delta, delta)));
    }
}

TEST(TemporalValue, Registers) {
    etlmon::Register a, b, c;
    for (const Value value : {etlmon::kTrue, etlmon::kFalse, Value{-3, 7}}) {
        a = value;
        b = a;
        c = min_of(etlmon::kTrue, b, a, value);
        EXPECT_TRUE(temporal::same(c, value) && temporal::same(b, value));
        EXPECT_TRUE(temporal::same(etlmon::settled(c).rho, value));
    }
}

static_assert(std::is_trivially_copyable_v<Value> && sizeof(Value) == 8, "two keys");
static_assert(std::is_trivially_copyable_v<etlmon::Register> && sizeof(etlmon::Register) == 8,
              "a value");
static_assert(std::is_trivially_copyable_v<Verdict> && std::is_standard_layout_v<Verdict>,
              "a record");
static_assert(sizeof(Verdict) == 16 && alignof(Verdict) == 4, "three floats and a status");
static_assert(max_of(etlmon::kFalse, etlmon::kTrue).low == etlmon::kTop, "usable in constants");

bool is_nan(float x) {
    return (etlmon::bits_of(x) & 0x7fffffffu) > 0x7f800000u;
}

TEST(TemporalVerdict, DefaultIsUndecided) {
    const Verdict verdict;
    EXPECT_TRUE(is_nan(verdict.robustness) && is_nan(verdict.lower) && is_nan(verdict.upper));
    EXPECT_FALSE(verdict.satisfied());
    EXPECT_FALSE(verdict.violated());
    EXPECT_FALSE(verdict.unknown());
    EXPECT_FALSE(verdict.decided());
    EXPECT_FALSE(verdict.final());
    EXPECT_FALSE(verdict.alarm());
    EXPECT_FALSE(verdict.fulfilled());
    EXPECT_FALSE(verdict.open());
}

/// Keys on both sides of zero, next to it and at the ends.
const Key kKeys[] = {etlmon::kBottom, -0x3f800000, -1, 0, 1, 0x3f800000, etlmon::kTop};

TEST(TemporalVerdict, EveryPrefixVerdict) {
    int statuses[3] = {0, 0, 0};
    for (const Key low : kKeys)
        for (const Key high : kKeys)
            for (const Key lower : kKeys)
                for (const Key upper : kKeys) {
                    if (low > high) continue;
                    const Verdict verdict = etlmon::prefix_verdict({low, high}, lower, upper);
                    ASSERT_EQ(etlmon::key_of(verdict.robustness), low);
                    ASSERT_EQ(etlmon::key_of(verdict.lower), lower);
                    ASSERT_EQ(etlmon::key_of(verdict.upper), upper);
                    ASSERT_EQ(verdict.satisfied(), low >= 0);
                    ASSERT_EQ(verdict.violated(), high < 0);
                    ASSERT_EQ(verdict.unknown(), low < 0 && high >= 0);
                    ASSERT_TRUE(verdict.decided());
                    const bool final = lower >= 0 || upper < 0;
                    ASSERT_EQ(verdict.final(), final);
                    ASSERT_EQ(verdict.open(), !final);
                    ASSERT_EQ(verdict.alarm(), final && high < 0);
                    ASSERT_EQ(verdict.fulfilled(), final && low >= 0);
                    ++statuses[verdict.satisfied() ? 0 : verdict.violated() ? 1 : 2];
                }
    EXPECT_GT(statuses[0], 0);
    EXPECT_GT(statuses[1], 0);
    EXPECT_GT(statuses[2], 0);
}

TEST(TemporalVerdict, EverySlidingVerdict) {
    for (const Key low : kKeys)
        for (const Key high : kKeys) {
            if (low > high) continue;
            const Verdict verdict = etlmon::sliding_verdict(Value{low, high});
            ASSERT_EQ(etlmon::key_of(verdict.robustness), low);
            ASSERT_EQ(etlmon::key_of(verdict.lower), low);
            ASSERT_EQ(etlmon::key_of(verdict.upper), high);
            ASSERT_EQ(verdict.satisfied(), low >= 0);
            ASSERT_EQ(verdict.violated(), high < 0);
            ASSERT_EQ(verdict.unknown(), low < 0 && high >= 0);
            ASSERT_TRUE(verdict.decided());
            ASSERT_TRUE(verdict.final());
            ASSERT_FALSE(verdict.open());
            ASSERT_EQ(verdict.alarm(), high < 0);
            ASSERT_EQ(verdict.fulfilled(), low >= 0);
        }
}

TEST(TemporalVerdict, NegativeZeroIsSatisfiedAndReportedAsZero) {
    const Value rho = etlmon::between(-0.0f, -0.0f);
    const Verdict verdict = etlmon::prefix_verdict(rho, rho.low, rho.high);
    EXPECT_TRUE(verdict.satisfied());
    EXPECT_TRUE(verdict.final());
    EXPECT_EQ(etlmon::bits_of(verdict.robustness), 0u);
}

}  // namespace
