// Checks the costs of windows: combinations in the worst step, counted by a monoid that also checks
// that every aggregate is exactly the last N elements in order; and bytes, compared with sizeof.
#include <gtest/gtest.h>

#include <algorithm>

#include "temporal_streams.hpp"

namespace {

using etlmon::Key;
using etlmon::Value;
using temporal::Bits;

/// Ranges of consecutive step numbers under concatenation: neither commutative nor idempotent. It
/// counts its combinations.
struct Stretch {
    struct Element {
        uint32_t first;
        uint32_t count;
        uint32_t broken;  ///< 1 if two non-adjacent ranges were joined
    };
    static constexpr bool kNewestLast = true;
    static uint32_t combinations;
    static Element identity() noexcept { return {0, 0, 0}; }
    static Element combine(Element older, Element newer) noexcept {
        ++combinations;
        if (older.count == 0) return newer;
        if (newer.count == 0) return older;
        const bool meet = older.first + older.count == newer.first;
        return {older.first, older.count + newer.count,
                older.broken | newer.broken | (meet ? 0u : 1u)};
    }
};
uint32_t Stretch::combinations = 0;

struct StretchFromTheOldest : Stretch {
    static constexpr bool kNewestLast = false;
};

/// Returns the most combinations in one step over `steps` steps; fails if an aggregate is not the
/// last n elements in order.
template <class Monoid>
uint32_t worst_step(uint32_t n, uint32_t steps) {
    std::vector<Stretch::Element> storage(etlmon::window_elements(n));
    uint32_t cursor = 0;
    uint32_t worst = 0;
    etlmon::window_reset<Monoid>(storage.data(), cursor, n);
    for (uint32_t t = 0; t < steps; ++t) {
        Stretch::combinations = 0;
        const Stretch::Element last =
            etlmon::window_push<Monoid>(storage.data(), cursor, n, {t, 1, 0});
        worst = std::max(worst, Stretch::combinations);
        const uint32_t count = std::min(n, t + 1);
        if (last.broken != 0 || last.count != count || last.first + count != t + 1) {
            ADD_FAILURE() << "length " << n << ", step " << t << ": " << last.count << " from "
                          << last.first;
            return 0;
        }
    }
    return worst;
}

TEST(TemporalCost, WorstStepOfEveryLengthTo300) {
    for (uint32_t n = 1; n <= 300; ++n) {
        ASSERT_EQ(worst_step<Stretch>(n, 5 * n + 7), etlmon::window_operations(n)) << n;
        ASSERT_EQ(worst_step<StretchFromTheOldest>(n, 5 * n + 7), etlmon::window_operations(n))
            << n;
    }
}

TEST(TemporalCost, WorstStepOfLongWindows) {
    for (const uint32_t n : {1000u, 1001u, 10000u, 65535u, 65536u, 100000u, 100001u})
        ASSERT_EQ(worst_step<Stretch>(n, 4 * n), etlmon::window_operations(n)) << n;
}

TEST(TemporalCost, StorageIsNeverMoreThanTwoBeyondTheLength) {
    for (uint32_t n = 1; n < 1000; ++n) {
        ASSERT_LE(etlmon::window_elements(n), n + 2);
        ASSERT_GE(etlmon::window_elements(n), n + 1);
    }
}

}  // namespace

namespace narrow {

/// A value type with less alignment than a cursor.
struct Byte {
    uint8_t bits;
};
constexpr Byte min_of(Byte a, Byte b) noexcept {
    return {static_cast<uint8_t>(a.bits & b.bits)};
}
constexpr Byte max_of(Byte a, Byte b) noexcept {
    return {static_cast<uint8_t>(a.bits | b.bits)};
}

}  // namespace narrow

template <>
struct etlmon::Lattice<narrow::Byte> {
    static constexpr narrow::Byte bottom() noexcept { return {0}; }
    static constexpr narrow::Byte top() noexcept { return {255}; }
};

namespace {

template <class Monoid, uint32_t N>
constexpr bool kWindowFits = sizeof(etlmon::Window<Monoid, N>) == etlmon::window_bytes<Monoid>(N) &&
                             alignof(etlmon::Window<Monoid, N>) == alignof(uint32_t);
template <class V, uint32_t N>
constexpr bool kDelayFits = sizeof(etlmon::Delay<V, N>) == etlmon::delay_bytes<V>(N) &&
                            alignof(etlmon::Delay<V, N>) == alignof(uint32_t);

static_assert(kWindowFits<etlmon::Greatest<Key>, 1> && kWindowFits<etlmon::Greatest<Key>, 10>);
static_assert(kWindowFits<etlmon::Least<Value>, 11> && kWindowFits<etlmon::Since<Value>, 101>);
static_assert(kWindowFits<etlmon::Until<Bits>, 4> && kWindowFits<etlmon::Release<float>, 100000>);
static_assert(kWindowFits<etlmon::Greatest<narrow::Byte>, 2> &&
              kWindowFits<etlmon::Trigger<narrow::Byte>, 7>);
static_assert(kDelayFits<Key, 1> && kDelayFits<Value, 7> && kDelayFits<narrow::Byte, 1> &&
              kDelayFits<narrow::Byte, 6>);
static_assert(sizeof(etlmon::Window<etlmon::Greatest<Key>, 1001>) == 4 + 4 * 1002);
static_assert(sizeof(etlmon::Window<etlmon::Since<Value>, 100>) == 4 + 12 + 2 * 8 * 102);
static_assert(sizeof(etlmon::Widening<etlmon::Greatest<Key>, 50, 80>) == 4 + 4 * 30);

TEST(TemporalCost, BytesAreThoseOfTheMembers) {
    EXPECT_EQ(etlmon::window_bytes<etlmon::Greatest<Key>>(1001), 4u + 4u * 1002u);
    EXPECT_EQ(etlmon::window_bytes<etlmon::Since<Value>>(100), 4u + 12u + 2u * 8u * 102u);
    EXPECT_EQ(etlmon::delay_bytes<Value>(50), 4u + 8u * 50u);
}

}  // namespace
