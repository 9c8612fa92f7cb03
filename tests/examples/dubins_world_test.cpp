// Tests the simulated world of examples/dubins, which the demo's figures depend on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "episode.hpp"
#include "npy.hpp"
#include "targets.hpp"

namespace demo {
namespace {

constexpr std::uint64_t kSeed = 3;
constexpr int kSteps = 240;

const std::vector<Episode>& tours() {
    static const std::vector<Episode> all = drive_tours(kSeed, 100, kSteps);
    return all;
}

/// Returns the first step inside the disc, or the number of steps.
std::size_t first_inside(const Episode& tour, const Disc& disc) {
    const auto inside = [&](const Car& car) { return disc.contains(car.position); };
    const auto found = std::find_if(tour.states.begin(), tour.states.end(), inside);
    return static_cast<std::size_t>(found - tour.states.begin());
}

TEST(DubinsWorld, CarsObeyTheirLimitsAndStayInside) {
    ASSERT_EQ(tours().size(), 100U);
    for (const Episode& tour : tours()) {
        ASSERT_EQ(tour.states.size(), static_cast<std::size_t>(kSteps));
        for (std::size_t i = 0; i < tour.states.size(); ++i) {
            ASSERT_TRUE(inside_world(tour.states[i].position));
            if (i == 0) continue;
            const Car& before = tour.states[i - 1];
            const Car& after = tour.states[i];
            const double turn = std::abs(std::remainder(after.heading - before.heading, 2 * kPi));
            ASSERT_LE(turn, kMaxTurnRate * kTimeStep + 1e-12);
            const double chord = distance(after.position, before.position);
            ASSERT_LE(chord, kSpeed * kTimeStep + 1e-12);
            ASSERT_GT(chord, 0.999 * kSpeed * kTimeStep);
        }
    }
}

TEST(DubinsWorld, DrivesAreTheSameForTheSameSeedAndDifferForAnother) {
    const std::vector<Episode> again = drive_tours(kSeed, 3, kSteps);
    const std::vector<Episode> other = drive_tours(kSeed + 1, 3, kSteps);
    for (std::size_t i = 0; i < again.size(); ++i) {
        EXPECT_EQ(again[i].states.back().position.x, tours()[i].states.back().position.x);
        EXPECT_NE(other[i].states.back().position.x, tours()[i].states.back().position.x);
    }
}

TEST(DubinsWorld, SomeDrivesFailInEveryWay) {
    const auto count = [](auto test) {
        return std::count_if(tours().begin(), tours().end(), test);
    };
    const std::size_t never = kSteps;
    EXPECT_GE(count([&](const Episode& t) { return first_inside(t, kGoalA) == never; }), 5);
    EXPECT_GE(count([&](const Episode& t) { return first_inside(t, kObstacleC) != never; }), 5);
    EXPECT_GE(count([&](const Episode& t) {
                  return first_inside(t, kGoalB) < first_inside(t, kGoalA) &&
                         first_inside(t, kGoalA) != never;
              }),
              5);
    EXPECT_GE(count([&](const Episode& t) {
                  return first_inside(t, kGoalA) < first_inside(t, kGoalB) &&
                         first_inside(t, kGoalB) != never;
              }),
              5);
}

TEST(DubinsWorld, TheCameraShowsTheCarWhereItIs) {
    for (const Car& car :
         {Car{{0.3, -0.7}, 0.0}, Car{{-1.1, 0.9}, 2.0}, Car{{1.45, -1.45}, -1.0}}) {
        const Image image = photograph(car);
        double ink = 0;
        double x = 0;
        double y = 0;
        for (int i = 0; i < kImageSide * kImageSide; ++i) {
            const double dark = 255 - image[static_cast<std::size_t>(i)];
            ink += dark;
            x += dark * (-kHalfWidth + (i % kImageSide + 0.5) * 2 * kHalfWidth / kImageSide);
            y += dark * (kHalfWidth - (i / kImageSide + 0.5) * 2 * kHalfWidth / kImageSide);
        }
        ASSERT_GT(ink, 0);
        EXPECT_LT(distance({x / ink, y / ink}, car.position), 0.05);
    }
}

TEST(DubinsWorld, TheCommittedComponentsAreOrthonormal) {
    const Eigen::MatrixXf components =
        read_matrix(DUBINS_FOLDER "/encoder/components.npy", kDimension, 1024);
    const Eigen::MatrixXf gram = components * components.transpose();
    EXPECT_LT((gram - Eigen::MatrixXf::Identity(kDimension, kDimension)).cwiseAbs().maxCoeff(),
              1e-5F);
}

/// Another CPU may round the last digits differently, but no more.
TEST(DubinsWorld, TheCommittedTargetsAreWhatTheCommittedEncoderMakes) {
    const Encoder encoder = Encoder::load(DUBINS_FOLDER "/encoder");
    for (const Region& region : kRegions) {
        const std::string path =
            std::string(DUBINS_FOLDER "/targets/") + std::string(region.name) + ".npy";
        const Eigen::MatrixXf committed = read_matrix(path, kTargetHeadings, kDimension);
        const std::vector<Embedding> made = target_set(encoder, region.disc.centre);
        for (int row = 0; row < kTargetHeadings; ++row) {
            for (int i = 0; i < kDimension; ++i) {
                ASSERT_NEAR(committed(row, i),
                            made[static_cast<std::size_t>(row)][static_cast<std::size_t>(i)], 1e-5)
                    << region.name << " row " << row;
            }
        }
    }
}

TEST(DubinsWorld, AFileOfAnotherShapeIsNamed) {
    try {
        read_matrix(DUBINS_FOLDER "/encoder/mean.npy", 2, 2);
        FAIL() << "a 1 x 1024 file was taken for 2 x 2";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("mean.npy"), std::string::npos);
    }
}

}  // namespace
}  // namespace demo
