// Compares the rows that may be nearest by full weights with the kernel on all rows.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "execute/tables.hpp"
#include "plan/targets/kernels.hpp"
#include "random.hpp"

namespace etlc::tests {
namespace {

/// Makes weights A A^T + I / `condition`, and points and rows of about `scale` around a point `off`
/// away.
struct Scene {
    check::Distance distance;
    check::Target target;
    std::vector<float> z;

    Scene(Random& random, double condition, double scale, double off) {
        const auto n = static_cast<std::uint32_t>(random.between(1, 30));
        target.dimension = n;
        target.rows = static_cast<std::uint32_t>(random.between(1, 50));
        distance.metric = check::Metric::mahalanobis;
        const auto number = [&] { return 2 * random.uniform() - 1; };
        std::vector<double> a(std::size_t{n} * n);
        std::generate(a.begin(), a.end(), number);
        distance.weights.resize(a.size());
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = i == j ? n / condition : 0;
                for (std::size_t k = 0; k < n; ++k) sum += a[i * n + k] * a[j * n + k];
                distance.weights[i * n + j] = distance.weights[j * n + i] = static_cast<float>(sum);
            }
        const auto coordinate = [&] { return static_cast<float>(scale * (off + number())); };
        target.values.resize(std::size_t{target.rows} * n);
        std::generate(target.values.begin(), target.values.end(), coordinate);
        if (target.rows > 2 && random.chance(0.5))  // the last row repeats the first
            std::copy_n(target.values.begin(), n, target.values.end() - n);
        z.resize(n);
        std::generate(z.begin(), z.end(), coordinate);
        if (random.chance(0.5))  // near a row
            for (std::size_t i = 0; i < n; ++i)
                z[i] = target.values[i] + static_cast<float>(1e-5 * scale * number());
    }

    etlmon::Measured measured(const std::vector<float>& rows) const {
        return plan::measure(distance, z.data(), rows.data(),
                             static_cast<std::uint32_t>(rows.size() / z.size()), target.dimension,
                             nullptr);
    }
    std::vector<float> only(const std::vector<std::uint32_t>& rows) const {
        std::vector<float> values;
        for (const std::uint32_t row : rows) {
            const auto begin = target.values.begin() + static_cast<std::ptrdiff_t>(row * z.size());
            values.insert(values.end(), begin, begin + static_cast<std::ptrdiff_t>(z.size()));
        }
        return values;
    }
};

TEST(NearRows, HoldTheNearestOfAll) {
    Random random(5);
    std::size_t all = 0;
    std::size_t kept = 0;
    for (int i = 0; i < 3000; ++i) {
        const double condition = i % 2 == 0 ? 1 : 1e7;
        const double scale = i % 5 == 0 ? 1e-22 : i % 7 == 0 ? 1e17 : i % 11 == 0 ? 1e30 : 1;
        Scene scene(random, condition, scale, i % 3 == 0 ? 1000 : 0);
        execute::NearRows near(scene.distance, scene.target);
        const std::vector<std::uint32_t> rows = near.of(scene.z.data(), 2);
        ASSERT_FALSE(rows.empty());
        ASSERT_TRUE(std::is_sorted(rows.begin(), rows.end()));
        const etlmon::Measured expected = scene.measured(scene.target.values);
        const etlmon::Measured found = scene.measured(scene.only(rows));
        ASSERT_EQ(found.delta, expected.delta) << i;
        ASSERT_EQ(rows[found.nearest], expected.nearest) << i;
        if (scale != 1 || condition != 1 || i % 3 == 0) continue;
        all += scene.target.rows;
        kept += rows.size();
    }
    EXPECT_LT(kept * 8, all) << "of " << all << " rows " << kept << " are measured";
}

}  // namespace
}  // namespace etlc::tests
