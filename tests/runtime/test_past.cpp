// Checks the numbers and samples of earlier steps under any flags: the delays and the windows
// against a search of the whole stream, and means against integers in which neither sums nor
// products round.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "etlmon/past/numbers.hpp"
#include "etlmon/past/points.hpp"

namespace {

constexpr std::uint32_t kNan = 0x7fc00000u;
constexpr std::uint32_t kInf = 0x7f800000u;
constexpr std::uint32_t kSign = 0x80000000u;

using Stream = std::vector<std::uint32_t>;  // the bits of floats

std::uint32_t any(std::mt19937& random) {
    return static_cast<std::uint32_t>(random());
}

std::uint32_t bits(float x) {
    std::uint32_t result = 0;
    std::memcpy(&result, &x, sizeof result);
    return result;
}

std::int64_t place(std::uint32_t of) {
    return (of & kSign) != 0 ? -static_cast<std::int64_t>(of & ~kSign)
                             : static_cast<std::int64_t>(of);
}

std::uint32_t at_place(std::int64_t place) {
    return place < 0 ? kSign | static_cast<std::uint32_t>(-place)
                     : static_cast<std::uint32_t>(place);
}

/// An integer of many digits, each of which may be negative: a sum has no carries.
class Integer {
public:
    /// Adds factor times the float, in units of 2^-149.
    void add(std::uint32_t of, std::int64_t factor) {
        const std::uint32_t exponent = (of & ~kSign) >> 23, fraction = of & 0x7fffffu;
        const std::int64_t significand = exponent == 0 ? fraction : fraction | 0x800000u;
        const std::uint32_t shift = exponent == 0 ? 0 : exponent - 1;
        const std::int64_t product = ((of & kSign) != 0 ? -factor : factor) * significand;
        const std::int64_t low = product % (1 << 24), high = product / (1 << 24);
        add_part(low, shift);
        add_part(high, shift + 24);
    }

    int sign() const {
        std::array<std::int64_t, kDigits> digits = digits_;
        for (std::size_t i = 0; i + 1 < kDigits; ++i) {
            std::int64_t carry = digits[i] / kBase;
            if (digits[i] % kBase < 0) --carry;
            digits[i] -= carry * kBase;
            digits[i + 1] += carry;
        }
        if (digits.back() != 0) return digits.back() < 0 ? -1 : 1;
        return std::any_of(digits.begin(), digits.end(), [](std::int64_t d) { return d != 0; });
    }

private:
    static constexpr std::size_t kDigits = 24;
    static constexpr std::int64_t kBase = 1 << 16;

    void add_part(std::int64_t part, std::uint32_t shift) {
        digits_[shift / 16] += part * (std::int64_t{1} << shift % 16);
    }

    std::array<std::int64_t, kDigits> digits_{};
};

/// Returns the sign of twice the sum of the numbers less n times what two floats add up to.
int sign_of_rest(const Stream& numbers, std::int64_t n, std::uint32_t a, std::uint32_t b) {
    Integer rest;
    for (const std::uint32_t x : numbers) rest.add(x, 2);
    rest.add(a, -n);
    rest.add(b, -n);
    return rest.sign();
}

/// Checks that no float is nearer to the sum divided by n, and that an even one was taken of two.
void expect_nearest(const Stream& numbers, std::int64_t n, std::uint32_t mean) {
    const int above = sign_of_rest(numbers, n, mean, at_place(place(mean) + 1));
    const int below = sign_of_rest(numbers, n, mean, at_place(place(mean) - 1));
    ASSERT_TRUE(above < 0 || (above == 0 && mean % 2 == 0)) << std::hex << mean;
    ASSERT_TRUE(below > 0 || (below == 0 && mean % 2 == 0)) << std::hex << mean;
}

/// Returns the last n numbers at a step; nothing if there are fewer or one of them is missing.
Stream window_at(const Stream& stream, std::size_t step, std::size_t n) {
    if (step + 1 < n) return {};
    Stream window(stream.begin() + static_cast<std::ptrdiff_t>(step + 1 - n),
                  stream.begin() + static_cast<std::ptrdiff_t>(step + 1));
    if (std::find(window.begin(), window.end(), kNan) != window.end()) return {};
    return window;
}

void expect_means(const Stream& stream, std::uint32_t n) {
    std::vector<std::uint32_t> storage(n);
    etlmon::MeanState state;
    state.reset();
    for (std::size_t step = 0; step < stream.size(); ++step) {
        const std::uint32_t mean = etlmon::mean_push(storage.data(), state, n, stream[step]);
        const Stream window = window_at(stream, step, n);
        const auto has = [&](std::uint32_t infinity) {
            return std::find(window.begin(), window.end(), infinity) != window.end();
        };
        SCOPED_TRACE(testing::Message() << n << " steps, step " << step);
        if (window.empty() || (has(kInf) && has(kInf | kSign)))
            ASSERT_EQ(mean, kNan);
        else if (has(kInf) || has(kInf | kSign))
            ASSERT_EQ(mean, has(kInf) ? kInf : kInf | kSign);
        else
            expect_nearest(window, n, mean);
        if (testing::Test::HasFatalFailure()) return;
    }
}

constexpr std::uint32_t kMeanLengths[] = {2, 3, 4, 5, 7, 20, 64, 129};

TEST(Past, MeansOfNumbersOfAllSizes) {
    std::mt19937 random(1);
    for (const std::uint32_t n : kMeanLengths) {
        for (const std::uint32_t exponents : {2u, 30u, 255u}) {
            Stream stream;
            const std::uint32_t least = exponents == 30 ? 110 : 0;
            for (int step = 0; step < 400; ++step) {
                const std::uint32_t exponent = least + any(random) % exponents;
                stream.push_back((any(random) & (kSign | 0x7fffffu)) | exponent << 23);
                if (any(random) % 200 == 0) stream.back() = kNan;
            }
            expect_means(stream, n);
        }
    }
}

TEST(Past, SumsDividedByAnyNumber) {
    std::mt19937 random(4);
    for (int i = 0; i < 20000; ++i) {
        etlmon::detail::ExactSum sum;
        sum.reset();
        Stream numbers;
        const std::uint32_t range = i % 2 == 0 ? 255 : 30, least = any(random) % (256 - range);
        for (std::uint32_t count = any(random) % 4; count > 0; --count) {
            const std::uint32_t exponent = least + any(random) % range;
            numbers.push_back((any(random) & (kSign | 0x7fffffu)) | exponent << 23);
            sum.add(numbers.back(), false);
        }
        const std::uint32_t n = i % 3 == 0 ? (1u << 24) - any(random) % 3
                                           : 1 + any(random) % (1u << (1 + any(random) % 24));
        const std::uint32_t mean = sum.divided_by(n);
        if ((mean & ~kSign) < 0x7f7fffffu)  // more numbers than n may exceed the floats
            expect_nearest(numbers, n, mean);
        if (HasFatalFailure()) return;
    }
}

TEST(Past, SumsThatCancel) {
    Stream stream;
    for (int i = 0; i < 60; ++i)
        for (const float x : {1e30F, 1.0F, -1e30F, 3e-45F, 1e-38F, -1.0F})
            stream.push_back(bits(x));
    for (const std::uint32_t n : kMeanLengths) expect_means(stream, n);
    std::vector<std::uint32_t> storage(3);
    etlmon::MeanState state;
    state.reset();
    std::uint32_t mean = 0;
    for (const float x : {7e7F, 1e30F, 6.0F, -1e30F})
        mean = etlmon::mean_push(storage.data(), state, 3, bits(x));
    EXPECT_EQ(mean, bits(2.0F));
}

TEST(Past, TheMeanOfEqualNumbersIsTheirs) {
    for (const std::uint32_t one : {0x1u, 0x3u, 0x7fffffu, 0x800000u, 0xffffffu, 0x3f800001u,
                                    0x7f7fffffu, 0x80000001u, 0xff7fffffu, 0xbf800001u})
        for (const std::uint32_t n : kMeanLengths) {
            std::vector<std::uint32_t> storage(n);
            etlmon::MeanState state;
            state.reset();
            for (std::uint32_t i = 1; i < n; ++i)
                ASSERT_EQ(etlmon::mean_push(storage.data(), state, n, one), kNan);
            for (std::uint32_t i = 0; i < 3 * n; ++i)
                ASSERT_EQ(etlmon::mean_push(storage.data(), state, n, one), one) << n;
        }
}

TEST(Past, TiesGoToEven) {
    Stream stream;
    for (const std::uint32_t x : {0u, 1u, 2u, 3u, 0x7fffffu, 0x800000u, 0x800001u, 0x1000000u,
                                  0x1000001u, 0x3f800000u, 0x3f800001u, 0x3f800002u})
        for (const std::uint32_t y : {x, x + 1, x + 2})
            stream.insert(stream.end(), {x, y, x | kSign});
    for (const std::uint32_t n : {2u, 4u}) expect_means(stream, n);
}

TEST(Past, MeansOfInfinities) {
    std::mt19937 random(2);
    Stream stream;
    for (int step = 0; step < 3000; ++step) {
        const std::uint32_t kind = any(random) % 24;
        stream.push_back(kind == 0   ? kInf
                         : kind == 1 ? kInf | kSign
                         : kind == 2 ? kNan
                                     : any(random) % 0x7f800000u);
    }
    for (const std::uint32_t n : {2u, 3u, 8u}) expect_means(stream, n);
}

/// Returns few different numbers, some of them missing.
Stream steps_of_all_kinds() {
    std::mt19937 random(3);
    Stream stream;
    const std::uint32_t numbers[] = {bits(1), bits(-2),     0x1u,   kSign | 1u,
                                     kInf,    kInf | kSign, bits(5)};
    for (int step = 0; step < 4000; ++step)
        stream.push_back(any(random) % 12 == 0 ? kNan : numbers[any(random) % 7]);
    return stream;
}

template <class Window, class Choose>
void expect_windows(std::uint32_t n, const Choose& chosen) {
    const Stream stream = steps_of_all_kinds();
    Window window{};
    window.reset();
    for (std::size_t step = 0; step < stream.size(); ++step) {
        const std::uint32_t found = bits(window.push(etlmon::float_of_bits(stream[step])));
        Stream all = window_at(stream, step, n);
        const auto less = [](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); };
        std::sort(all.begin(), all.end(), less);
        ASSERT_EQ(found, all.empty() ? kNan : chosen(all)) << n << " steps, step " << step;
    }
}

template <std::uint32_t N>
void expect_extremes() {
    expect_windows<etlmon::MovingMin<N>>(N, [](const Stream& all) { return all.front(); });
    expect_windows<etlmon::MovingMax<N>>(N, [](const Stream& all) { return all.back(); });
}

TEST(Past, TheLeastAndTheGreatest) {
    expect_extremes<2>();
    expect_extremes<3>();
    expect_extremes<4>();
    expect_extremes<7>();
    expect_extremes<16>();
}

TEST(Past, ANumberOfAWhileAgo) {
    const Stream stream = steps_of_all_kinds();
    etlmon::Ago<5> ago{};
    ago.reset();
    for (std::size_t step = 0; step < stream.size(); ++step)
        ASSERT_EQ(bits(ago.push(etlmon::float_of_bits(stream[step]))),
                  step < 5 ? kNan : stream[step - 5]);
}

TEST(Past, AResetForgets) {
    etlmon::MovingMean<2> mean{};
    etlmon::MovingMax<2> max{};
    etlmon::Ago<1> ago{};
    for (int episode = 0; episode < 3; ++episode) {
        mean.reset();
        max.reset();
        ago.reset();
        EXPECT_TRUE(etlmon::is_nan(mean.push(4)));
        EXPECT_TRUE(etlmon::is_nan(max.push(4)));
        EXPECT_TRUE(etlmon::is_nan(ago.push(4)));
        EXPECT_EQ(bits(mean.push(1)), bits(2.5F));
        EXPECT_EQ(bits(max.push(1)), bits(4));
        EXPECT_EQ(bits(ago.push(1)), bits(4));
    }
}

/// The bytes of a sample; none: it is missing.
template <class Element>
using Sample = std::vector<Element>;

/// Returns the sample that a monitor gets: the last one again where a missing one is held.
template <class Element>
Sample<Element> taken(const std::vector<Sample<Element>>& before, const Sample<Element>& sample,
                      bool is_held) {
    return sample.empty() && is_held && !before.empty() ? before.back() : sample;
}

/// Holds every sample of up to Steps steps ago to those that came, in episodes that begin in
/// memory full of ones.
template <class Element, std::uint32_t Dim, std::uint32_t Steps>
void expect_earlier() {
    using Ring = etlmon::Earlier<Element, Dim, Steps>;
    static_assert(sizeof(Ring) == etlmon::earlier_bytes(sizeof(Element), Dim, Steps));
    std::mt19937 random(5 + Dim + Steps);
    static Ring ring;
    for (const std::uint32_t missing_of_8 : {0u, 1u, 4u, 7u}) {
        std::memset(static_cast<void*>(&ring), 0xff, sizeof ring);
        ring.reset();
        std::vector<Sample<Element>> past;
        for (std::size_t step = 0; step < 3 * Steps + 5; ++step) {
            for (std::uint32_t ago = 1; ago <= Steps; ++ago) {
                const Element* found = ring.at(ago);
                const bool expected = ago <= step && !past[step - ago].empty();
                ASSERT_EQ(found != nullptr, expected) << "step " << step << ", " << ago << " ago";
                if (!expected) continue;
                ASSERT_EQ(std::memcmp(found, past[step - ago].data(), Dim * sizeof(Element)), 0)
                    << "step " << step << ", " << ago << " ago";
            }
            Sample<Element> sample(any(random) % 8 < missing_of_8 ? 0 : Dim);
            for (Element& element : sample) {
                const std::uint32_t drawn = any(random);
                std::memcpy(&element, &drawn, sizeof element);
            }
            const bool is_held = any(random) % 2 != 0;
            const Element* given = sample.empty() ? nullptr : sample.data();
            if (is_held || step % 2 != 0)
                ring.push(given, is_held);
            else
                ring.push(given);
            past.push_back(taken(past, sample, is_held));
        }
    }
}

template <class Element>
void expect_earlier_of_all_sizes() {
    expect_earlier<Element, 1, 1>();
    expect_earlier<Element, 3, 2>();
    expect_earlier<Element, 5, 3>();
    expect_earlier<Element, 1, 31>();
    expect_earlier<Element, 2, 32>();
    expect_earlier<Element, 3, 33>();
    expect_earlier<Element, 7, 64>();
    expect_earlier<Element, 1, 65>();
    expect_earlier<Element, 33, 100>();
}

TEST(Past, SamplesAsTheyCame) {
    expect_earlier_of_all_sizes<float>();
    expect_earlier_of_all_sizes<std::uint16_t>();
    expect_earlier_of_all_sizes<std::int8_t>();
}

TEST(Past, AHeldSampleIsMissingIfNoneCame) {
    etlmon::Earlier<float, 2, 3> ring{};
    ring.reset();
    ring.push(nullptr, true);
    EXPECT_EQ(ring.at(1), nullptr);
    const float sample[] = {1, 2};
    ring.push(sample, false);
    ring.push(nullptr, true);
    ring.push(nullptr, false);
    ring.push(nullptr, true);  // nothing is held any more
    EXPECT_EQ(ring.at(1), nullptr);
    EXPECT_EQ(ring.at(2), nullptr);
    ASSERT_NE(ring.at(3), nullptr);
    EXPECT_EQ(bits(ring.at(3)[1]), bits(2));
    ring.reset();
    for (std::uint32_t ago = 1; ago <= 3; ++ago) EXPECT_EQ(ring.at(ago), nullptr);
}

}  // namespace
