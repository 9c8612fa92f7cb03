// Rows of float16 give the same bits as the float32 rows that they widen to, in every version of
// the kernel, and so within the same bounds.
#include "narrow_cases.hpp"

namespace {

using namespace narrow_cases;

TEST(Halves, EachWidensToItself) {
    for (std::uint32_t bits_of_half = 0; bits_of_half < 0x10000; ++bits_of_half) {
        const auto narrow = static_cast<std::uint16_t>(bits_of_half);
        const bool is_finite = (bits_of_half & 0x7c00) != 0x7c00;
        const float one = is_finite ? half(narrow) : etlmon::detail::element(&narrow, 0);
        ASSERT_EQ(bits(etlmon::detail::element(&narrow, 0)), bits(one)) << bits_of_half;
        ASSERT_EQ(etlmon::is_finite(one), is_finite) << bits_of_half;
        std::uint16_t many[19];
        float widened[19];
        std::fill(many, many + 19, narrow);
        for (const auto widen : widenings<const std::uint16_t*>()) {
            widen(many, widened, 19);
            for (const float& x : widened) {
                if (is_finite) {
                    ASSERT_EQ(bits(x), bits(one)) << bits_of_half;
                } else {  // a NaN may come back with another payload
                    ASSERT_FALSE(etlmon::is_finite(x)) << bits_of_half;
                }
            }
        }
    }
}

TEST(Halves, WidenWhateverTheirNumber) {
    const Narrow narrow = make_narrow(Storage::f16, MetricId::l2, 1, 70, Kind::mixed);
    expect_widened(narrow.halves.data(), 70);
}

#define DISTANCE(id, Type, prepared, zero_is_unknown)                    \
    TEST(Halves, SameAsWidened_##id) {                                   \
        expect_metric<const std::uint16_t*>(Storage::f16, MetricId::id); \
    }
#include "etlmon/distance/distances.def"
#undef DISTANCE

inline constexpr std::uint16_t kHalves[64 * 5] = {0x3c00, 0x4001, 0x8001, 0x3555,
                                                  0xbbbb, 0x7bff, 0x0400};
inline constexpr float kWideHalves[64 * 5] = {
    1.0F, 2.001953125F, -5.9604645e-8F, 0.333251953125F, -0.9663086F, 65504.0F, 6.1035156e-5F};

/// Columns, as the compiler stores constants.
TEST(Halves, InColumns) {
    using namespace etlmon;
    const float z[5] = {1.5F, -0.25F, 3.0F, 1e-3F, -1.0F};
    const Measured narrow = measure<L2, Min, 64, 5, kHalves>(z),
                   wide = measure<L2, Min, 64, 5, kWideHalves>(z);
    EXPECT_EQ(bits(narrow.delta), bits(wide.delta));
    EXPECT_EQ(narrow.nearest, wide.nearest);
}

}  // namespace
