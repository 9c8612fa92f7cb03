// Tests adaptive thresholds: the update against integers, the bound on misses on adversarial
// sequences, and arbitrary distances and stored thresholds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "etlmon/temporal/adaptation.hpp"

namespace {

using etlmon::Adaptation;
using etlmon::adapted;
using etlmon::is_at_least;
using etlmon::is_at_most;
using etlmon::restored;

const float kTop = etlmon::float_of(etlmon::kTop);
const float kBottom = etlmon::float_of(etlmon::kBottom);

double wide(float x) {
    return static_cast<double>(x);
}

/// Makes them as etlc does, mirrored for >=; alpha and gamma are in extended precision, which
/// exceeds every rounding here.
struct Rule {
    long double alpha;
    long double gamma;
    Adaptation by;
    bool mirrored;

    float start(double share) const {
        const double steps =
            std::round((wide(by.lo) + share * (wide(by.hi) - wide(by.lo))) / wide(by.grid));
        return std::clamp(static_cast<float>(steps) * by.grid, by.lo, by.hi);
    }
};

Rule rule(long double alpha, long double gamma, double lo, double hi, bool mirrored) {
    const double grid = std::ldexp(1.0, std::ilogb(std::max(std::abs(lo), std::abs(hi))) - 23);
    const long double length = static_cast<long double>(grid);
    const auto miss = static_cast<float>(std::ceil(gamma * (1 - alpha) / length) * length);
    const auto hit = static_cast<float>(std::floor(gamma * alpha / length) * length);
    return {alpha,
            gamma,
            {static_cast<float>(std::floor(lo / grid) * grid),
             static_cast<float>(std::ceil(hi / grid) * grid), mirrored ? -miss : miss,
             mirrored ? hit : -hit, static_cast<float>(grid)},
            mirrored};
}

std::vector<Rule> rules() {
    std::vector<Rule> result;
    for (const bool mirrored : {false, true}) {
        result.push_back(rule(0.1L, 0.01L, 0.1, 0.6, mirrored));
        result.push_back(rule(0.25L, 0.5L, -1, 1, mirrored));
        result.push_back(rule(0.01L, 0.001L, 0, 0.3, mirrored));
        result.push_back(rule(0.9L, 0.05L, -7.3, -0.2, mirrored));
        result.push_back(rule(0.3L, 100.0L, -2e5, 1e6, mirrored));
        result.push_back(rule(1.0L / 3, 1e-30L, 0, 1e-28, mirrored));
    }
    return result;
}

etlmon::Truth found(const Rule& rule, const float& distance, const float& epsilon) {
    return rule.mirrored ? is_at_least(distance, epsilon) : is_at_most(distance, epsilon);
}

/// Returns the threshold as a number of grid steps.
std::int64_t steps(const Rule& rule, float x) {
    return static_cast<std::int64_t>(
        std::llround(static_cast<double>(x) / static_cast<double>(rule.by.grid)));
}

TEST(Adaptation, NoUpdateIsRounded) {
    std::mt19937_64 engine(1);
    for (const Rule& r : rules()) {
        float epsilon = r.start(0.4);
        std::int64_t exact = steps(r, epsilon);
        for (int n = 0; n < 20000; ++n) {
            const float distance =
                static_cast<float>(wide(r.by.lo) + (wide(r.by.hi) - wide(r.by.lo)) *
                                                       static_cast<double>(engine() % 1000) / 999);
            const bool hit = r.mirrored ? distance >= epsilon : distance <= epsilon;
            exact += steps(r, hit ? r.by.on_hit : r.by.on_miss);
            exact = std::clamp(exact, steps(r, r.by.lo), steps(r, r.by.hi));
            epsilon = adapted(epsilon, found(r, distance, epsilon), r.by);
            ASSERT_EQ(wide(epsilon), static_cast<double>(exact) * wide(r.by.grid));
        }
    }
}

/// Chooses the next positive frame, knowing the threshold.
using World = std::function<double(const Rule&, float epsilon, std::uint64_t n)>;

/// Returns a point between the strict and the generous end.
double along(const Rule& r, double share) {
    const double towards = r.mirrored ? 1 - share : share;
    return wide(r.by.lo) + towards * (wide(r.by.hi) - wide(r.by.lo));
}

double beyond(const Rule& r, float epsilon) {
    const double grid = wide(r.by.grid);
    return wide(epsilon) + (r.mirrored ? -grid : grid);
}

std::vector<World> worlds() {
    auto engine = std::make_shared<std::mt19937_64>(2);
    const auto uniform = [engine] { return static_cast<double>((*engine)() >> 11U) * 0x1p-53; };
    return {
        // Misses by a little while the range has room, for ever.
        [](const Rule& r, float epsilon, std::uint64_t) { return beyond(r, epsilon); },
        // Misses beyond every possible threshold.
        [](const Rule& r, float, std::uint64_t) { return along(r, 1.5); },
        // Easy frames, so that the threshold tightens, then a run of misses; repeated.
        [](const Rule& r, float epsilon, std::uint64_t n) {
            return n % 2000 < 1500 ? along(r, -1) : beyond(r, epsilon);
        },
        // Random frames that drift from one end to beyond the other.
        [uniform](const Rule& r, float, std::uint64_t n) {
            return along(r, 0.2 * uniform() + static_cast<double>(n) / 15000);
        },
        [uniform](const Rule& r, float, std::uint64_t) { return along(r, 2 * uniform() - 0.5); },
        // Occasional random misses.
        [uniform](const Rule& r, float epsilon, std::uint64_t) {
            return uniform() < 0.5 ? beyond(r, epsilon) : along(r, -1);
        },
    };
}

/// docs/calibration.md, "What is guaranteed", for every prefix.
TEST(Adaptation, MissesStayBelowTheBound) {
    for (const Rule& r : rules())
        for (const World& world : worlds()) {
            float epsilon = r.start(0.3);
            const long double room =
                r.mirrored ? static_cast<long double>(epsilon) - static_cast<long double>(r.by.lo)
                           : static_cast<long double>(r.by.hi) - static_cast<long double>(epsilon);
            std::uint64_t misses = 0;
            std::uint64_t held_back = 0;
            for (std::uint64_t n = 1; n <= 15000; ++n) {
                const auto distance = static_cast<float>(world(r, epsilon, n));
                const bool miss = r.mirrored ? distance < epsilon : distance > epsilon;
                const double wanted = wide(epsilon) + wide(r.by.on_miss);
                const bool held = r.mirrored ? wanted < wide(r.by.lo) : wanted > wide(r.by.hi);
                misses += miss ? 1 : 0;
                held_back += miss && held ? 1 : 0;
                epsilon = adapted(epsilon, found(r, distance, epsilon), r.by);
                ASSERT_LE(r.by.lo, epsilon);
                ASSERT_LE(epsilon, r.by.hi);
                const long double bound = r.alpha * static_cast<long double>(n) + room / r.gamma +
                                          (1 - r.alpha) * static_cast<long double>(held_back);
                ASSERT_LE(static_cast<long double>(misses), bound * (1 + 1e-12L));
            }
        }
}

/// The bound is tight: a sequence that misses until the range is used up has as many misses as it
/// allows.
TEST(Adaptation, TheBoundIsTight) {
    const Rule r = rule(0.25L, 0.5L, 0, 4, false);  // all exact
    float epsilon = 1;
    std::uint64_t misses = 0;
    while (epsilon + r.by.on_miss <= r.by.hi) {
        ++misses;
        epsilon = adapted(epsilon, etlmon::kNo, r.by);
        ASSERT_EQ(static_cast<double>(misses),
                  0.25 * static_cast<double>(misses) + (wide(epsilon) - 1) / 0.5);
    }
    EXPECT_EQ(misses, 8U);
}

TEST(Adaptation, HeldBackAtTheEnds) {
    const Rule r = rule(0.25L, 0.5L, -1, 1, false);
    EXPECT_EQ(adapted(1, etlmon::kNo, r.by), 1);
    EXPECT_EQ(adapted(0.75F, etlmon::kNo, r.by), 1);
    EXPECT_EQ(adapted(-1, etlmon::kYes, r.by), -1);
    EXPECT_EQ(adapted(-0.9375F, etlmon::kYes, r.by), -1);
    const Rule mirror = rule(0.25L, 0.5L, -1, 1, true);
    EXPECT_EQ(adapted(-0.75F, etlmon::kNo, mirror.by), -1);
    EXPECT_EQ(adapted(1, etlmon::kYes, mirror.by), 1);
}

TEST(Adaptation, DistancesThatAreNoNumbers) {
    for (const bool mirrored : {false, true}) {
        const Rule r = rule(0.25L, 0.5L, -1, 1, mirrored);
        EXPECT_EQ(adapted(0.25F, found(r, etlmon::kMissing, 0.25F), r.by), 0.25F);  // changes
                                                                                    // nothing
        const float hit = 0.25F + r.by.on_hit;
        const float miss = 0.25F + r.by.on_miss;
        EXPECT_EQ(adapted(0.25F, found(r, kTop, 0.25F), r.by), mirrored ? hit : miss);
        EXPECT_EQ(adapted(0.25F, found(r, kBottom, 0.25F), r.by), mirrored ? miss : hit);
    }
}

TEST(Adaptation, KeptThresholdsComeBack) {
    std::mt19937_64 engine(3);
    for (const Rule& r : rules()) {
        float epsilon = r.start(0.5);
        for (int n = 0; n < 1000; ++n) {
            epsilon = adapted(epsilon, etlmon::truth_of(engine() % 2 == 0), r.by);
            ASSERT_EQ(restored(epsilon, r.by.lo, r.by), epsilon);
        }
        EXPECT_EQ(restored(kTop, r.by.lo, r.by), r.by.hi);
        EXPECT_EQ(restored(kBottom, r.by.hi, r.by), r.by.lo);
        EXPECT_EQ(restored(std::numeric_limits<float>::max(), r.by.lo, r.by), r.by.hi);
        EXPECT_EQ(restored(std::numeric_limits<float>::lowest(), r.by.lo, r.by), r.by.lo);
        EXPECT_EQ(restored(etlmon::kMissing, epsilon, r.by), epsilon);
        for (int n = 0; n < 1000; ++n) {  // any bits that memory may contain
            const auto bits = static_cast<std::uint32_t>(engine());
            float any = 0;
            etlmon::detail::copy_bytes(&any, &bits, sizeof any);
            const float got = restored(any, epsilon, r.by);
            ASSERT_LE(r.by.lo, got);
            ASSERT_LE(got, r.by.hi);
            ASSERT_EQ(static_cast<double>(got),
                      static_cast<double>(steps(r, got)) * wide(r.by.grid));
        }
    }
}

}  // namespace
