// Tests views, flags and presence of samples.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "etlmon/distance/widen.hpp"
#include "etlmon/views.hpp"

namespace {

using etlmon::Flag;
using etlmon::kMissing;
using etlmon::Vector;
using View = Vector<float, 6>;

// Conversions that work, and ones that must not compile.
static_assert(std::is_convertible_v<float (&)[6], View>);
static_assert(std::is_convertible_v<const float (&)[6], View>);
static_assert(std::is_convertible_v<std::array<float, 6>&, View>);
static_assert(std::is_convertible_v<const std::array<float, 6>&, View>);
static_assert(!std::is_constructible_v<View, float (&)[5]>);
static_assert(!std::is_constructible_v<View, std::array<float, 7>&>);
static_assert(!std::is_constructible_v<View, std::array<double, 6>&>);
static_assert(!std::is_constructible_v<View, std::array<float, 6>>, "a temporary");
static_assert(!std::is_constructible_v<View, std::vector<float>&>, "24 bytes, as six floats are");
static_assert(!std::is_constructible_v<View, std::string&>);
static_assert(!std::is_constructible_v<View, const float*>);
static_assert(!std::is_constructible_v<View, std::nullptr_t>);
static_assert(!std::is_constructible_v<View, Vector<float, 5>>);
static_assert(std::is_trivially_copyable_v<View> && sizeof(View) == sizeof(void*));
static_assert(std::is_convertible_v<std::array<std::uint16_t, 3>&, Vector<std::uint16_t, 3>>);
static_assert(std::is_convertible_v<std::int8_t (&)[3], Vector<std::int8_t, 3>>);

static_assert(std::is_convertible_v<bool, Flag> && std::is_convertible_v<bool&, Flag>);
static_assert(!std::is_constructible_v<Flag, int> && !std::is_constructible_v<Flag, float>);
static_assert(!std::is_constructible_v<Flag, const char*> &&
              !std::is_constructible_v<Flag, std::nullptr_t>);
static_assert(std::is_trivially_copyable_v<Flag> && sizeof(Flag) == 1);
static_assert(!Flag().present() && Flag(true).present() && Flag(true).value() &&
              Flag(false).present());
static_assert(!Flag(false).value() && !Flag().value());

/// Like std::span: no default constructor, a size in its type.
struct Span {
    static constexpr std::size_t extent = 6;
    explicit Span(const float* at) : at_(at) {}
    const float* data() const { return at_; }
    const float* at_;
};
static_assert(std::is_convertible_v<Span, View> &&
              !std::is_constructible_v<Vector<float, 5>, Span>);

float from_bits(std::uint32_t b) {
    volatile std::uint32_t bits = b;
    const std::uint32_t copy = bits;
    float x;
    std::memcpy(&x, &copy, sizeof x);
    return x;
}

const std::vector<std::uint32_t> kNotFiniteBits{0x7f800000, 0xff800000, 0x7fc00000,
                                                0xffc00000, 0x7f800001, 0xffffffff};
const std::vector<std::uint32_t> kFinite{0,          0x80000000, 1,          0x80000001,
                                         0x007fffff, 0x7f7fffff, 0xff7fffff, 0x3f800000};

TEST(Views, SeeWhatTheyView) {
    float numbers[6] = {1, 2, 3, 4, 5, 6};
    View view;
    EXPECT_FALSE(view.present());
    EXPECT_FALSE(present(view));
    view = numbers;
    EXPECT_EQ(view.data(), numbers);
    EXPECT_TRUE(present(view));
    view = View();
    EXPECT_FALSE(view.present());
    EXPECT_TRUE(View::unchecked(numbers).present());
    EXPECT_FALSE(View::unchecked(nullptr).present());
    const std::array<float, 6> array{};
    EXPECT_EQ(View(array).data(), array.data());
}

TEST(Views, OneElementThatIsNotFiniteIsMissing) {
    for (std::size_t n = 1; n <= 21; ++n) {
        for (std::size_t at = 0; at < n; ++at) {
            std::vector<float> x(n, 1.0F);
            for (const std::uint32_t b : kFinite) {
                x[at] = from_bits(b);
                EXPECT_TRUE(etlmon::finite(x.data(), n)) << n << " " << at << " " << b;
            }
            for (const std::uint32_t b : kNotFiniteBits) {
                x[at] = from_bits(b);
                EXPECT_FALSE(etlmon::finite(x.data(), n)) << n << " " << at << " " << b;
            }
            std::vector<std::uint16_t> h(n, 0x7bff);
            EXPECT_TRUE(etlmon::finite(h.data(), n));
            for (const unsigned b : {0x7c00U, 0xfc00U, 0x7e00U, 0xffffU, 0x7c01U}) {
                h[at] = static_cast<std::uint16_t>(b);
                EXPECT_FALSE(etlmon::finite(h.data(), n)) << n << " " << at << " " << b;
            }
        }
    }
    const float nothing[6] = {1, 2, 3, 4, 5, from_bits(0x7fc00000)};
    EXPECT_FALSE(present(View(nothing)));
    const std::int8_t small[3] = {-128, 0, 127};
    EXPECT_TRUE(present(Vector<std::int8_t, 3>(small)));
    EXPECT_FALSE(present(Vector<std::int8_t, 3>()));
}

TEST(Views, ScalarsAreFiniteAndInRange) {
    for (const std::uint32_t b : kNotFiniteBits) {
        EXPECT_TRUE(etlmon::is_nan(etlmon::accept(from_bits(b)))) << b;
        EXPECT_TRUE(etlmon::is_nan(
            etlmon::accept(from_bits(b), from_bits(0xff800000), from_bits(0x7f800000))))
            << b;
    }
    for (const std::uint32_t b : kFinite) {
        EXPECT_FALSE(etlmon::is_nan(etlmon::accept(from_bits(b)))) << b;
        EXPECT_FALSE(etlmon::is_nan(
            etlmon::accept(from_bits(b), from_bits(0xff800000), from_bits(0x7f800000))))
            << b;
    }
    EXPECT_FALSE(etlmon::is_nan(etlmon::accept(0.0F, -0.0F, 1.0F)));
    EXPECT_FALSE(etlmon::is_nan(etlmon::accept(-0.0F, 0.0F, 1.0F)));
    EXPECT_FALSE(etlmon::is_nan(etlmon::accept(1.0F, 0.0F, 1.0F)));
    EXPECT_TRUE(etlmon::is_nan(etlmon::accept(1.00000012F, 0.0F, 1.0F)));
    EXPECT_TRUE(etlmon::is_nan(etlmon::accept(from_bits(0x80000001), 0.0F, 1.0F)))
        << "a negative denormal";
    EXPECT_TRUE(etlmon::is_nan(etlmon::accept(-3.0F, -2.0F, -1.0F)));
    EXPECT_FALSE(etlmon::is_nan(etlmon::accept(-1.5F, -2.0F, -1.0F)));
    EXPECT_TRUE(etlmon::is_nan(etlmon::accept(kMissing)));
    EXPECT_TRUE(etlmon::is_nan(kMissing));
}

/// By the definition: sign, exponent and mantissa of IEEE 754 binary16, in double.
double half_value(std::uint16_t h) {
    const int exponent = (h >> 10) & 0x1f;
    const double mantissa = h & 0x3ff;
    const double size =
        exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
    return (h & 0x8000) != 0 ? -size : size;
}

TEST(Storage, EveryFloat16WidensExactly) {
    for (std::uint32_t h = 0; h < 0x10000; ++h) {
        const auto half = static_cast<std::uint16_t>(h);
        float wide = 0;
        etlmon::widen_f16(&half, &wide, 1);
        std::uint32_t b = 0;
        std::memcpy(&b, &wide, sizeof b);
        EXPECT_EQ(b >> 31, h >> 15);
        if ((h & 0x7c00) == 0x7c00) {
            EXPECT_EQ(b & 0x7f800000, 0x7f800000U) << h;
            EXPECT_EQ((b & 0x7fffff) != 0, (h & 0x3ff) != 0) << h;
        } else {
            EXPECT_EQ(static_cast<double>(wide), half_value(half)) << h;
        }
    }
}

TEST(Storage, Int8IsScaleTimesInteger) {
    for (const float scale : {1.0F, 0.0078125F, 0.1F, 3e-39F}) {
        for (int i = -128; i < 128; ++i) {
            const auto small = static_cast<std::int8_t>(i);
            float wide = 1;
            etlmon::widen_i8(&small, scale, &wide, 1);
            EXPECT_EQ(wide, scale * static_cast<float>(i));
        }
    }
}

TEST(Storage, ManyAtOnceAsOneByOne) {
    constexpr std::uint32_t kAtOnce = 7;
    for (std::uint32_t first = 0; first + kAtOnce <= 0x10000; first += kAtOnce) {
        std::uint16_t halves[kAtOnce];
        std::int8_t bytes[kAtOnce];
        float from_halves[kAtOnce], from_bytes[kAtOnce];
        for (std::uint32_t i = 0; i < kAtOnce; ++i) {
            halves[i] = static_cast<std::uint16_t>(first + i);
            bytes[i] = static_cast<std::int8_t>(first + i);
        }
        etlmon::widen_f16(halves, from_halves, kAtOnce);
        etlmon::widen_i8(bytes, 0.1F, from_bytes, kAtOnce);
        for (std::uint32_t i = 0; i < kAtOnce; ++i) {
            float one = 0;
            etlmon::widen_f16(&halves[i], &one, 1);
            ASSERT_EQ(std::memcmp(&one, &from_halves[i], sizeof one), 0) << first + i;
            etlmon::widen_i8(&bytes[i], 0.1F, &one, 1);
            ASSERT_EQ(std::memcmp(&one, &from_bytes[i], sizeof one), 0) << first + i;
        }
    }
}

}  // namespace
