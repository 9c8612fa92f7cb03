// A search gives, step by step, the bits of the plain kernel on the same rows: every distance that
// it supports, every order of additions, any path of the embedding. Other tests compare the plain
// kernel with the definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <vector>

#include "etlmon/distance/search.hpp"

namespace {

std::uint32_t bits(float x) {
    std::uint32_t word = 0;
    std::memcpy(&word, &x, sizeof word);
    return word;
}

/// Makes K padded rows of D elements in clusters of `near` rows, with some rows twice.
template <std::uint32_t K, std::uint32_t D>
struct Rows {
    static constexpr std::uint32_t kStride = etlmon::detail::padded(D);
    std::vector<float> floats = std::vector<float>(std::size_t{K} * kStride + 16);

    Rows(std::uint32_t seed, std::uint32_t near, bool unit) {
        std::mt19937 random(seed);
        std::normal_distribution<float> normal;
        std::vector<float> center(D);
        for (std::uint32_t k = 0; k < K; ++k) {
            if (k % near == 0)
                for (float& x : center) x = normal(random);
            float* row = at(k);
            double square = 0;
            for (std::uint32_t i = 0; i < D; ++i) {
                row[i] = k % 7 == 6 ? at(k - 3)[i] : center[i] + 0.02F * normal(random);
                square += double{row[i]} * double{row[i]};
            }
            if (unit)
                for (std::uint32_t i = 0; i < D; ++i)
                    row[i] = static_cast<float>(row[i] / std::sqrt(square));
        }
    }
    float* at(std::uint32_t k) { return floats.data() + std::size_t{k} * kStride; }
};

/// Returns the next embedding.
template <class Set>
void move(std::vector<float>& z, Set& rows, std::uint32_t count, std::mt19937& random, float pace) {
    std::normal_distribution<float> normal;
    const float* row = rows.at(static_cast<std::uint32_t>(random()) % count);
    const float* other = rows.at(static_cast<std::uint32_t>(random()) % count);
    const auto kind = random() % 100;
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (kind == 0) z[i] = row[i];
        if (kind == 1) z[i] = normal(random);
        if (kind == 2) z[i] = row[i] * 1e-22F;
        if (kind == 3) z[i] = row[i] * 1e37F;
        if (kind == 4) z[i] = 0;
        if (kind == 5) z[i] = 0.5F * (row[i] + other[i]);
        if (kind == 6) z[i] = std::nextafter(row[i], 9.0F);
        if (kind > 10) z[i] += pace * normal(random);
        if (std::abs(z[i]) > 1e38F) z[i] = row[i];
    }
    if (kind > 10 && (std::abs(z[0]) > 1e3F || std::abs(z[0]) < 1e-6F))
        z.assign(row, row + z.size());
}

template <class Metric, std::uint32_t K, std::uint32_t D>
void expect_plain(std::uint32_t seed, std::uint32_t near, float pace, int steps) {
    Rows<K, D> rows(seed, near, Metric::kDirection);
    std::mt19937 random(seed + 1);
    std::vector<float> z(rows.at(K / 2), rows.at(K / 2) + D);
    const auto search = std::make_unique<etlmon::Search<K, D>>();
    search->reset();
    for (int step = 0; step < steps; ++step) {
        move(z, rows, K, random, pace);
        if (random() % 97 == 0) search->reset();
        const etlmon::Measured found = search->template nearest<Metric>(z.data(), rows.at(0));
        const etlmon::Measured plain =
            etlmon::measure_stored<Metric, etlmon::Min, K, D>(z.data(), rows.at(0));
        ASSERT_EQ(bits(found.delta), bits(plain.delta))
            << "step " << step << ", seed " << seed << ", pace " << pace;
        ASSERT_EQ(found.nearest, plain.nearest)
            << "step " << step << ", seed " << seed << ", pace " << pace;
    }
}

template <class Metric>
void expect_plain() {
    std::uint32_t seed = 1;
    for (const float pace : {0.0F, 1e-4F, 1e-3F, 0.01F, 0.1F}) {
        for (const std::uint32_t near : {1U, 7U, 64U, 500U}) {
            expect_plain<Metric, 300, 33>(++seed, near, pace, 300);  // in lanes
            expect_plain<Metric, 500, 5>(++seed, near, pace, 300);   // in sequence
        }
        expect_plain<Metric, 1100, 500>(++seed, 64, pace, 100);  // in one stream, with rows dropped
                                                                 // early
    }
}

TEST(Search, L2) {
    expect_plain<etlmon::L2>();
}
TEST(Search, L2Sq) {
    expect_plain<etlmon::L2Sq>();
}
TEST(Search, L1) {
    expect_plain<etlmon::L1>();
}
TEST(Search, Linf) {
    expect_plain<etlmon::Linf>();
}
TEST(Search, Cosine) {
    expect_plain<etlmon::Cosine>();
}

/// Two rows on a line, in different blocks, and z on it: first almost at one of them, then halfway
/// between them up to a few roundings. The triangle inequality is tight here, so only the margin
/// for rounding keeps the second row from being skipped.
template <class Metric>
void expect_plain_between_equals() {
    constexpr std::uint32_t kRows = 300, kDimension = 33, kFirst = 7, kSecond = 150;
    Rows<kRows, kDimension> rows(5, 1, true);
    for (float& x : rows.floats) x *= 1e4F;
    const auto search = std::make_unique<etlmon::Search<kRows, kDimension>>();
    std::mt19937 random(9);
    std::normal_distribution<float> normal;
    std::uniform_real_distribution<float> share(0.1F, 0.9F);
    int nearest_second = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        std::vector<float> line(kDimension), z(kDimension);
        for (float& x : line) x = normal(random);
        for (std::uint32_t i = 0; i < kDimension; ++i)
            rows.at(kFirst)[i] = -line[i], rows.at(kSecond)[i] = line[i];
        const float start = -share(random), end = 2e-7F * normal(random);
        search->reset();
        for (const float at : {start, end}) {
            for (std::uint32_t i = 0; i < kDimension; ++i) z[i] = at * line[i];
            const etlmon::Measured found = search->template nearest<Metric>(z.data(), rows.at(0));
            const etlmon::Measured plain =
                etlmon::measure_stored<Metric, etlmon::Min, kRows, kDimension>(z.data(),
                                                                               rows.at(0));
            ASSERT_EQ(bits(found.delta), bits(plain.delta)) << "trial " << trial;
            ASSERT_EQ(found.nearest, plain.nearest) << "trial " << trial;
            nearest_second += plain.nearest == kSecond;
        }
    }
    EXPECT_GT(nearest_second, 1000);
}

TEST(Search, BetweenEquals) {
    expect_plain_between_equals<etlmon::L2>();
    expect_plain_between_equals<etlmon::L2Sq>();
    expect_plain_between_equals<etlmon::L1>();
    expect_plain_between_equals<etlmon::Linf>();
}

}  // namespace
