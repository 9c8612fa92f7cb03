// Compares delays and windows with loops written from the operators' definitions: every length up
// to 70, samples of long ones, all Boolean streams of length 9, over keys, floats, pairs of keys,
// truth values and packed Booleans.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "temporal_streams.hpp"

namespace {

using etlmon::Key;
using etlmon::Value;
using temporal::Bits;
using temporal::random_streams;
using temporal::same;
using temporal::Streams;
using temporal::Truth;

/// The window functions with separate storage, as an interpreter uses them.
template <class Monoid>
class RuntimeWindow {
public:
    using Element = typename Monoid::Element;
    explicit RuntimeWindow(uint32_t n) : n_(n), storage_(etlmon::window_elements(n)) {
        etlmon::window_reset<Monoid>(storage_.data(), cursor_, n_);
    }
    Element push(Element element) {
        return etlmon::window_push<Monoid>(storage_.data(), cursor_, n_, element);
    }

private:
    uint32_t n_;
    uint32_t cursor_ = 0;
    std::vector<Element> storage_;
};

constexpr size_t kNone = ~size_t{0};

/// Pushes the streams through `window`; returns the first of the `checked` steps that differs from
/// the definition, or kNone.
template <class Case, class Window, class Checked>
size_t first_mismatch(Window& window, uint32_t n, const Streams<typename Case::Value>& streams,
                      Checked checked) {
    for (size_t i = 0; i < streams.g.size(); ++i) {
        const auto value = Case::result(window.push(Case::element(streams, i)));
        const size_t first = i + 1 < n ? 0 : i + 1 - n;
        if (checked(i) && !same(value, Case::defined(streams, first, i))) return i;
    }
    return kNone;
}

constexpr auto kEveryStep = [](size_t) { return true; };

template <class Case>
class TemporalWindow : public testing::Test {};

template <class V>
using CasesOf =
    testing::Types<temporal::GreatestCase<V>, temporal::LeastCase<V>, temporal::SinceCase<V>,
                   temporal::TriggerCase<V>, temporal::UntilCase<V>, temporal::ReleaseCase<V>>;

using AllCases = testing::Types<
    temporal::GreatestCase<Key>, temporal::LeastCase<Key>, temporal::SinceCase<Key>,
    temporal::TriggerCase<Key>, temporal::UntilCase<Key>, temporal::ReleaseCase<Key>,
    temporal::GreatestCase<Value>, temporal::LeastCase<Value>, temporal::SinceCase<Value>,
    temporal::TriggerCase<Value>, temporal::UntilCase<Value>, temporal::ReleaseCase<Value>,
    temporal::GreatestCase<float>, temporal::LeastCase<float>, temporal::TriggerCase<float>,
    temporal::UntilCase<float>, temporal::LeastCase<Bits>, temporal::SinceCase<Bits>,
    temporal::GreatestCase<Truth>, temporal::LeastCase<Truth>, temporal::SinceCase<Truth>,
    temporal::TriggerCase<Truth>, temporal::UntilCase<Truth>, temporal::ReleaseCase<Truth>,
    temporal::HandoverCase<Key>, temporal::CoveredCase<Value>, temporal::CoveredCase<Truth>>;
TYPED_TEST_SUITE(TemporalWindow, AllCases, temporal::CaseNames);

TYPED_TEST(TemporalWindow, EveryLengthTo70) {
    for (uint32_t n = 1; n <= 70; ++n) {
        RuntimeWindow<typename TypeParam::Monoid> window(n);
        const auto streams = random_streams<typename TypeParam::Value>(5 * n + 20, n);
        ASSERT_EQ(first_mismatch<TypeParam>(window, n, streams, kEveryStep), kNone) << n;
    }
}

/// The class for one length, reset in the middle of streams, without remains of the earlier ones.
template <class Case, uint32_t N>
size_t first_mismatch_of_class() {
    const auto window = std::make_unique<etlmon::Window<typename Case::Monoid, N>>();
    for (const uint32_t length : {N / 2 + 1, 3 * N + 5, N / 3 + 2, 4 * N}) {
        window->reset();
        const auto streams = random_streams<typename Case::Value>(length, N + length);
        const size_t mismatch = first_mismatch<Case>(*window, N, streams, kEveryStep);
        if (mismatch != kNone) return mismatch;
    }
    return kNone;
}

TYPED_TEST(TemporalWindow, ClassesAndReset) {
    EXPECT_EQ((first_mismatch_of_class<TypeParam, 1>()), kNone);
    EXPECT_EQ((first_mismatch_of_class<TypeParam, 2>()), kNone);
    EXPECT_EQ((first_mismatch_of_class<TypeParam, 3>()), kNone);
    EXPECT_EQ((first_mismatch_of_class<TypeParam, 6>()), kNone);
    EXPECT_EQ((first_mismatch_of_class<TypeParam, 101>()), kNone);
}

// ---- pairs of keys, whose highs are only kept up where they differ from the lows

/// Random pairs with equal ends except in bursts, which follow `quiet` steps and in which one in
/// `rarity` differs.
Streams<Value> with_bursts(size_t length, uint32_t quiet, uint32_t rarity, uint32_t seed) {
    Streams<Value> streams = random_streams<Value>(length, seed);
    std::mt19937 random(seed + 1);
    const auto close = [&](Value& value, size_t i) {
        const bool burst = i / quiet % 2 == 1;
        if (!burst || random() % rarity != 0) value.high = value.low;
    };
    for (size_t i = 0; i < length; ++i) {
        close(streams.g[i], i);
        close(streams.f[i], i);
    }
    return streams;
}

template <class Case, uint32_t N>
void expect_bursts() {
    const auto window = std::make_unique<etlmon::Window<typename Case::Monoid, N>>();
    static_assert(sizeof(*window) == etlmon::window_bytes<typename Case::Monoid>(N),
                  "as the budget says");
    for (const uint32_t quiet : {1u, N / 2 + 1, N, 2 * N + 3})
        for (const uint32_t rarity : {1u, 3u, N + 1}) {
            window->reset();
            const auto streams = with_bursts(9 * N + 20, quiet, rarity, N + 100 * quiet + rarity);
            EXPECT_EQ(first_mismatch<Case>(*window, N, streams, kEveryStep), kNone)
                << N << " " << quiet << " " << rarity;
        }
}

template <class Case, uint32_t... N>
void expect_bursts_of(std::integer_sequence<uint32_t, N...>) {
    (expect_bursts<Case, N + 1>(), ...);
}

template <class Case>
class TemporalPairWindow : public testing::Test {};
using PairCases = testing::Types<temporal::GreatestCase<Value>, temporal::LeastCase<Value>,
                                 temporal::SinceCase<Value>, temporal::TriggerCase<Value>,
                                 temporal::UntilCase<Value>, temporal::ReleaseCase<Value>,
                                 temporal::HandoverCase<Value>, temporal::CoveredCase<Value>>;
TYPED_TEST_SUITE(TemporalPairWindow, PairCases, temporal::CaseNames);

TYPED_TEST(TemporalPairWindow, HighsPartFromLowsAndMeetAgain) {
    expect_bursts_of<TypeParam>(std::make_integer_sequence<uint32_t, 8>());
    expect_bursts<TypeParam, 13>();
    expect_bursts<TypeParam, 40>();
    expect_bursts<TypeParam, 101>();
}

template <class Case>
class TemporalLongWindow : public testing::Test {};
TYPED_TEST_SUITE(TemporalLongWindow, CasesOf<Value>, temporal::CaseNames);

TYPED_TEST(TemporalLongWindow, SampledTo100000) {
    for (const uint32_t n : {255u, 1000u, 1001u, 9999u, 65536u, 99999u, 100000u}) {
        RuntimeWindow<typename TypeParam::Monoid> window(n);
        const uint32_t block = n / 2;
        const uint32_t stride = n / 9 + 1;
        // A stride, and the steps on both sides of block boundaries.
        const auto checked = [=](size_t i) { return i % stride == 0 || (i + 2) % block <= 3; };
        ASSERT_EQ(
            first_mismatch<TypeParam>(window, n, random_streams<Value>(3 * n + 7, n), checked),
            kNone)
            << n;
    }
}

/// All streams: 4^length pairs of Boolean signals, 32 side by side. Min and max commute with
/// thresholds, so a property of all Boolean streams of a length holds for all values.
template <class Case>
class TemporalBooleanWindow : public testing::Test {};
TYPED_TEST_SUITE(TemporalBooleanWindow, CasesOf<Bits>, temporal::CaseNames);

TYPED_TEST(TemporalBooleanWindow, AllStreamsOfLength9) {
    constexpr uint32_t kLength = 9;
    for (uint32_t batch = 0; batch < (1u << (2 * kLength)); batch += 32) {
        Streams<Bits> streams{std::vector<Bits>(kLength, {0}), std::vector<Bits>(kLength, {0})};
        for (uint32_t lane = 0; lane < 32; ++lane)
            for (uint32_t i = 0; i < kLength; ++i) {
                streams.g[i].word |= ((batch + lane) >> i & 1u) << lane;
                streams.f[i].word |= ((batch + lane) >> (i + kLength) & 1u) << lane;
            }
        for (uint32_t n = 1; n <= kLength; ++n) {
            RuntimeWindow<typename TypeParam::Monoid> window(n);
            ASSERT_EQ(first_mismatch<TypeParam>(window, n, streams, kEveryStep), kNone)
                << n << ' ' << batch;
        }
    }
}

template <class Case>
class TemporalWidening : public testing::Test {};
using WideningCases =
    testing::Types<temporal::GreatestCase<Key>, temporal::LeastCase<Key>, temporal::SinceCase<Key>,
                   temporal::TriggerCase<Key>, temporal::UntilCase<Key>, temporal::ReleaseCase<Key>,
                   temporal::SinceCase<Value>, temporal::ReleaseCase<Bits>>;
TYPED_TEST_SUITE(TemporalWidening, WideningCases, temporal::CaseNames);

template <class Case, uint32_t M, uint32_t N>
struct WidenedWindow {
    etlmon::Window<typename Case::Monoid, M> shorter;
    etlmon::Widening<typename Case::Monoid, M, N> widening;
    WidenedWindow() {
        shorter.reset();
        widening.reset();
    }
    auto push(typename Case::Monoid::Element element) {
        return widening.push(shorter.push(element));
    }
};

template <class Case, uint32_t M, uint32_t N>
bool widens() {
    WidenedWindow<Case, M, N> window;
    return first_mismatch<Case>(window, N, random_streams<typename Case::Value>(6 * N + 20, N),
                                kEveryStep) == kNone;
}

TYPED_TEST(TemporalWidening, ShortestToLongest) {
    EXPECT_TRUE((widens<TypeParam, 1, 2>()));
    EXPECT_TRUE((widens<TypeParam, 2, 3>()));
    EXPECT_TRUE((widens<TypeParam, 2, 4>()));
    EXPECT_TRUE((widens<TypeParam, 9, 10>()));
    EXPECT_TRUE((widens<TypeParam, 9, 14>()));
    EXPECT_TRUE((widens<TypeParam, 9, 18>()));
}

TEST(TemporalDelay, EveryLengthTo70) {
    for (uint32_t n = 1; n <= 70; ++n) {
        const auto streams = random_streams<Value>(4 * n + 3, n);
        std::vector<Value> storage(n, etlmon::kTrue);
        uint32_t cursor = 0;
        for (size_t i = 0; i < streams.g.size(); ++i) {
            const Value past = etlmon::delay_push(storage.data(), cursor, n, streams.g[i]);
            ASSERT_TRUE(same(past, i < n ? etlmon::kTrue : streams.g[i - n])) << n << ' ' << i;
        }
    }
}

template <class V, uint32_t N>
void expect_delay(V fill) {
    const auto delay = std::make_unique<etlmon::Delay<V, N>>();
    for (uint32_t round = 0; round < 3; ++round) {
        delay->reset(fill);
        const auto streams = random_streams<V>(2 * N + 1 + round, round);
        for (size_t i = 0; i < streams.g.size(); ++i)
            ASSERT_TRUE(same(delay->push(streams.g[i]), i < N ? fill : streams.g[i - N]))
                << N << ' ' << i;
    }
}

TEST(TemporalDelay, ClassesAndReset) {
    expect_delay<Key, 1>(5);
    expect_delay<Value, 2>(etlmon::kFalse);
    expect_delay<float, 3>(1.5f);
    expect_delay<Bits, 64>({7});
    expect_delay<Truth, 1>(etlmon::kYes);
    expect_delay<Truth, 16>(etlmon::kPerhaps);
    expect_delay<Truth, 17>(etlmon::kNo);
    expect_delay<Truth, 100>(etlmon::kYes);
    expect_delay<Value, 100000>(etlmon::kTrue);
}

}  // namespace
