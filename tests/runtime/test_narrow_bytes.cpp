// Rows of int8 give the same bits as the float32 rows that they widen to, in every version of the
// kernel, and so within the same bounds.
#include "narrow_cases.hpp"

namespace {

using namespace narrow_cases;

TEST(Bytes, WidenWhateverTheirNumber) {
    const Narrow narrow = make_narrow(Storage::i8, MetricId::l2, 1, 70, Kind::mixed);
    expect_widened(ScaledRows{narrow.bytes.data(), narrow.scale}, 70);
}

#define DISTANCE(id, Type, prepared, zero_is_unknown)         \
    TEST(Bytes, SameAsWidened_##id) {                         \
        expect_metric<ScaledRows>(Storage::i8, MetricId::id); \
    }
#include "etlmon/distance/distances.def"
#undef DISTANCE

inline constexpr std::int8_t kBytes[64 * 5] = {1, -128, 127, 0, 5, -7};
inline constexpr float kWideBytes[64 * 5] = {0.5F, -64.0F, 63.5F, 0.0F, 2.5F, -3.5F};

/// Columns, as the compiler stores constants.
TEST(Bytes, InColumns) {
    using namespace etlmon;
    const float z[5] = {1.5F, -0.25F, 3.0F, 1e-3F, -1.0F};
    const Measured narrow = measure_scaled<L1, Max, 64, 5, kBytes>(z, 0.5F),
                   wide = measure<L1, Max, 64, 5, kWideBytes>(z);
    EXPECT_EQ(bits(narrow.delta), bits(wide.delta));
    EXPECT_EQ(narrow.nearest, wide.nearest);
}

}  // namespace
