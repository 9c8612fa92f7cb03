// Checks that StaleAfter notices a change of any bit of any element, under any flags.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>

#include "etlmon/temporal/stale.hpp"

namespace {

template <class Element>
class Stale : public testing::Test {};
using Elements = testing::Types<float, std::uint16_t, std::int8_t>;
TYPED_TEST_SUITE(Stale, Elements, );

constexpr std::uint32_t kDim = 67;

template <class Element>
void flip(Element& element, unsigned bit) {
    unsigned char bytes[sizeof element];
    std::memcpy(bytes, &element, sizeof element);
    bytes[bit / 8] = static_cast<unsigned char>(bytes[bit / 8] ^ (1u << bit % 8));
    std::memcpy(&element, bytes, sizeof element);
}

TYPED_TEST(Stale, EveryBitOfEveryElementCounts) {
    etlmon::StaleAfter<TypeParam, kDim, 1> stale{};
    TypeParam sample[kDim] = {};
    ASSERT_TRUE(stale.accepts(sample));
    ASSERT_FALSE(stale.accepts(sample));
    for (TypeParam& element : sample)
        for (unsigned bit = 0; bit < 8 * sizeof element; ++bit) {
            flip(element, bit);
            ASSERT_TRUE(stale.accepts(sample)) << bit;
            ASSERT_FALSE(stale.accepts(sample)) << bit;
        }
}

TYPED_TEST(Stale, TheFirstSampleAfterAResetCounts) {
    etlmon::StaleAfter<TypeParam, kDim, 3> stale{};
    const TypeParam sample[kDim] = {};
    for (int episode = 0; episode < 2; ++episode) {
        for (int step = 0; step < 3; ++step) EXPECT_TRUE(stale.accepts(sample));
        for (int step = 0; step < 3; ++step) EXPECT_FALSE(stale.accepts(sample));
        stale.reset();
    }
}

TYPED_TEST(Stale, KeepsTheSampleInItsOwnTypeAndACounter) {
    constexpr std::size_t kWords = (kDim * sizeof(TypeParam) + 3) / 4 + 1;
    EXPECT_EQ(sizeof(etlmon::StaleAfter<TypeParam, kDim, 5>), 4 * kWords);
}

TEST(StaleScalar, AMissingOneChangesNothing) {
    etlmon::StaleAfter<float, 1, 2> stale{};
    const float missing = etlmon::kMissing;
    EXPECT_TRUE(etlmon::is_nan(stale.accept(missing)));
    EXPECT_EQ(stale.accept(0.5f), 0.5f);
    EXPECT_TRUE(etlmon::is_nan(stale.accept(missing)));
    EXPECT_EQ(stale.accept(0.5f), 0.5f);
    EXPECT_TRUE(etlmon::is_nan(stale.accept(missing)));
    EXPECT_TRUE(etlmon::is_nan(stale.accept(0.5f)));
    EXPECT_EQ(stale.accept(0.25f), 0.25f);
    EXPECT_EQ(stale.accept(0.5f), 0.5f);
}

TEST(StaleScalar, TheLongestTimeIsExact) {
    etlmon::StaleAfter<float, 1, std::numeric_limits<std::int32_t>::max() - 1> stale{};
    for (int step = 0; step < 100000; ++step) ASSERT_EQ(stale.accept(1.0f), 1.0f);
}

}  // namespace
