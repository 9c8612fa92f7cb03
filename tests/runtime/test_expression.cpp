// Tests the arithmetic of EXPR: IEEE 754 results by bits, for any flags of this file; NaN is never
// lost.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "etlmon/temporal/expression.hpp"

namespace {

constexpr std::uint32_t kInf = 0x7f800000, kMinusInf = 0xff800000, kNan = 0x7fc00000,
                        kMinusNan = 0xffc00000;
constexpr std::uint32_t kOne = 0x3f800000, kMinusOne = 0xbf800000, kZero = 0,
                        kMinusZero = 0x80000000, kTwo = 0x40000000, kFour = 0x40800000,
                        kMost = 0x7f7fffff, kTenth = 0x3dcccccd, kThird = 0x3eaaaaab,
                        kThree = 0x40400000;

float hidden(std::uint32_t b) {
    volatile std::uint32_t kept = b;
    const std::uint32_t bits = kept;
    float x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

std::uint32_t bits(const float& x) {
    std::uint32_t b = 0;
    std::memcpy(&b, &x, sizeof b);
    return (b & 0x7fffffff) > kInf ? kNan : b;  // all NaNs are equal
}

using Binary = float (*)(float, float);
const Binary kAdd = [](float a, float b) { return etlmon::add(a, b); };
const Binary kSubtract = [](float a, float b) { return etlmon::subtract(a, b); };
const Binary kMultiply = [](float a, float b) { return etlmon::multiply(a, b); };
const Binary kDivide = [](float a, float b) { return etlmon::divide(a, b); };
const Binary kSmaller = [](float a, float b) { return etlmon::smaller(a, b); };
const Binary kGreater = [](float a, float b) { return etlmon::greater(a, b); };

struct Row {
    Binary operation;
    std::uint32_t a, b, result;
};

TEST(Expression, BinaryOperationsFollowIeee) {
    const std::vector<Row> rows{
        {kAdd, kOne, kOne, kTwo},
        {kAdd, kInf, kOne, kInf},
        {kAdd, kInf, kMinusInf, kNan},
        {kAdd, kMost, kMost, kInf},
        {kSubtract, kInf, kInf, kNan},
        {kSubtract, kOne, kOne, kZero},
        {kSubtract, kMinusInf, kInf, kMinusInf},
        {kMultiply, kZero, kInf, kNan},
        {kMultiply, kMost, kTwo, kInf},
        {kMultiply, kMinusOne, kInf, kMinusInf},
        {kMultiply, kTwo, kTwo, kFour},
        {kDivide, kZero, kZero, kNan},
        {kDivide, kOne, kZero, kInf},
        {kDivide, kMinusOne, kZero, kMinusInf},
        {kDivide, kOne, kMinusZero, kMinusInf},
        {kDivide, kInf, kInf, kNan},
        {kDivide, kOne, kInf, kZero},
        {kDivide, kOne, kThree, kThird},
        {kSmaller, kOne, kTwo, kOne},
        {kSmaller, kTwo, kOne, kOne},
        {kSmaller, kMinusInf, kInf, kMinusInf},
        {kSmaller, kMinusOne, kMinusInf, kMinusInf},
        {kGreater, kOne, kTwo, kTwo},
        {kGreater, kMinusInf, kInf, kInf},
        {kGreater, kMinusOne, kMinusInf, kMinusOne},
        {kGreater, kMinusOne, kTenth, kTenth},
    };
    for (const Row& row : rows) {
        EXPECT_EQ(bits(row.operation(hidden(row.a), hidden(row.b))), row.result)
            << &row - rows.data() << ": " << std::hex << row.a << ", " << row.b;
    }
}

TEST(Expression, NanOperandsGiveNan) {
    for (const Binary operation : {kAdd, kSubtract, kMultiply, kDivide, kSmaller, kGreater}) {
        for (const std::uint32_t nan : {kNan, kMinusNan, 0x7f800001U, 0xffffffffU}) {
            for (const std::uint32_t other : {kZero, kOne, kMinusOne, kInf, kMinusInf, kNan}) {
                EXPECT_EQ(bits(operation(hidden(nan), hidden(other))), kNan)
                    << std::hex << nan << ", " << other;
                EXPECT_EQ(bits(operation(hidden(other), hidden(nan))), kNan)
                    << std::hex << other << ", " << nan;
            }
        }
    }
    EXPECT_EQ(bits(etlmon::root(hidden(kNan))), kNan);
    EXPECT_EQ(bits(etlmon::absolute(hidden(kMinusNan))), kNan);
    EXPECT_EQ(bits(etlmon::negate(hidden(kNan))), kNan);
}

TEST(Expression, UnaryOperations) {
    EXPECT_EQ(bits(etlmon::absolute(hidden(kMinusOne))), kOne);
    EXPECT_EQ(bits(etlmon::absolute(hidden(kMinusInf))), kInf);
    EXPECT_EQ(bits(etlmon::absolute(hidden(kMinusZero))), kZero);
    EXPECT_EQ(bits(etlmon::negate(hidden(kInf))), kMinusInf);
    EXPECT_EQ(bits(etlmon::negate(hidden(kMinusOne))), kOne);
    EXPECT_EQ(bits(etlmon::root(hidden(kInf))), kInf);
    EXPECT_EQ(bits(etlmon::root(hidden(kMinusZero))), kMinusZero);
    EXPECT_EQ(bits(etlmon::root(hidden(kMinusOne))), kNan);
    EXPECT_EQ(bits(etlmon::root(hidden(kMinusInf))), kNan);
    EXPECT_EQ(bits(etlmon::root(hidden(0x80000001U))), kNan) << "a negative denormal";
    EXPECT_NEAR(etlmon::root(hidden(kFour)), 2.0F, 5e-7F);
}

TEST(Expression, NeitherFusesNorReassociates) {
    // 0.1 * 0.1 rounds; fused, the difference from it would be the rounding error and not 0.
    const float tenth = hidden(kTenth);
    const float square = etlmon::multiply(tenth, tenth);
    EXPECT_EQ(bits(etlmon::subtract(etlmon::multiply(tenth, tenth), square)), kZero);
    // (1 + 2^-30) - 1 is 0 as written, but 2^-30 if reassociated.
    const float small = hidden(0x30800000);
    EXPECT_EQ(bits(etlmon::subtract(etlmon::add(hidden(kOne), small), hidden(kOne))), kZero);
    // a / 3 is a division, not a product with a rounded reciprocal.
    for (std::uint32_t i = 1; i < 1000; ++i) {
        const float a = static_cast<float>(i);
        const auto exact = static_cast<float>(static_cast<double>(i) / 3.0);
        EXPECT_EQ(bits(etlmon::divide(a, 3.0F)), bits(exact)) << i;
    }
}

TEST(Expression, ExtremesAreCompared) {
    EXPECT_EQ(bits(etlmon::smaller(hidden(1), hidden(2))), 1U) << "denormals";
    EXPECT_EQ(bits(etlmon::greater(hidden(0x80000001U), hidden(0x80000002U))), 0x80000001U);
    EXPECT_EQ(bits(etlmon::smaller(hidden(kMinusZero), hidden(kZero))), kMinusZero)
        << "equal: the first";
    EXPECT_EQ(bits(etlmon::greater(hidden(kZero), hidden(kMinusZero))), kZero);
}

}  // namespace
