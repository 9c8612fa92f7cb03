// Tests drifts: the runtime's state against a literal urn, the simulated rate of false alarms and
// the delay of true ones, and what reboots and cut episodes leave. ETLC_EFFORT=1 simulates 100,000
// runs and prints the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "check/guarantees/drift.hpp"
#include "etlmon/temporal/drift.hpp"

namespace {

using etlc::check::Drawn;
using etlmon::Drift;
using etlmon::DriftCells;
using etlmon::DriftState;
using etlmon::kDriftCells;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The definition in double, gap by gap. A gap is the number of scores of calibration below it;
/// every new score adds one to the balls of its gap.
class Urn {
public:
    Urn(std::vector<Drawn> scores, std::uint32_t random)
        : scores_(std::move(scores)), balls_(scores_.size() + 1, 1), random_(random) {}

    void add(float score) {
        random_ ^= random_ << 13U;
        random_ ^= random_ >> 17U;
        random_ ^= random_ << 5U;
        const Drawn drawn{score, random_};
        const auto gap = static_cast<std::size_t>(std::count_if(
            scores_.begin(), scores_.end(), [&](const Drawn& one) { return one < drawn; }));
        const double x = x_of(gap);
        double mean = 0;
        const double all = std::accumulate(balls_.begin(), balls_.end(), 0.0);
        for (std::size_t g = 0; g < balls_.size(); ++g) mean += balls_[g] / all * x_of(g);
        for (int bet = -1; bet <= 1; ++bet) accounts[bet + 1] *= 1 + bet * (x - mean);
        const double sum = wealth();
        for (double& account : accounts) account += 0.01 * (sum / 3 - account);
        ++balls_[gap];
        ++counts[cell_of(gap)];
    }
    double wealth() const { return accounts[0] + accounts[1] + accounts[2]; }

    double accounts[3] = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    std::uint32_t counts[kDriftCells] = {};

private:
    /// The cell j, from 1, has the gaps from (n + 1) (j - 1) / 8 on, rounded down.
    std::size_t cell_of(std::size_t gap) const {
        std::size_t cell = 0;
        while (gap >= balls_.size() * (cell + 1) / kDriftCells) ++cell;
        return cell;
    }
    double x_of(std::size_t gap) const {
        return (static_cast<double>(cell_of(gap)) + 0.5) / kDriftCells;
    }

    std::vector<Drawn> scores_;
    std::vector<double> balls_;
    std::uint32_t random_;
};

DriftCells cells_of(const std::vector<float>& scores, double level) {
    return etlc::check::drift_cells(etlc::check::draw(scores), level);
}

void end(Drift& drift, float score, const DriftCells& cells) {
    drift.see(score);
    drift.end(cells);
}

TEST(Drift, IsTheUrnOfAllGaps) {
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    for (int run = 0; run < 300; ++run) {
        const std::size_t n = 7 + random() % 60;
        const float grid = run % 3 == 0 ? 0.0F : run % 3 == 1 ? 0.5F : 2.0F;
        const auto score = [&] {
            if (run % 5 == 0 && random() % 4 == 0)
                return random() % 2 == 0 ? kInfinity : -kInfinity;
            const float x = normal(random) + (run % 7 == 0 ? 0.5F : 0.0F);
            return grid > 0 ? std::round(x / grid) * grid : x;
        };
        std::vector<float> scores;
        for (std::size_t i = 0; i < n; ++i) scores.push_back(score());
        const DriftCells cells = cells_of(scores, 1e-9);
        Drift drift(cells);
        Urn urn(etlc::check::draw(scores), drift.state().random);
        for (int episode = 0; episode < 200 && urn.wealth() < 1e8; ++episode) {
            const float next = score();
            end(drift, next, cells);
            urn.add(next);
            ASSERT_TRUE(std::equal(urn.counts, urn.counts + kDriftCells, drift.state().counts));
            for (int bet = 0; bet < 3; ++bet)
                ASSERT_NEAR(drift.state().accounts[bet], urn.accounts[bet],
                            1e-4 * urn.accounts[bet]);
        }
    }
}

TEST(Drift, CellsHaveAllGapsAndAtLeastOneEach) {
    for (std::size_t n = 7; n < 200; ++n) {
        std::vector<float> scores(n);
        std::iota(scores.begin(), scores.end(), 0.0F);
        const DriftCells cells = cells_of(scores, 0.01);
        EXPECT_EQ(std::accumulate(std::begin(cells.gaps), std::end(cells.gaps), 0U), n + 1);
        EXPECT_GE(*std::min_element(std::begin(cells.gaps), std::end(cells.gaps)), 1U);
        EXPECT_TRUE(std::is_sorted(std::begin(cells.ends), std::end(cells.ends)));
        EXPECT_EQ(cells.limit, 100);
        EXPECT_NE(cells.id, 0U);
    }
}

struct Found {
    double share = 0;
    int median = 0;  ///< delay in episodes
};

/// Simulates runs of 500 episodes after `from`, from which on scores are shifted by one standard
/// deviation; -1: never. `grid`: what scores are rounded to; 0: nothing.
Found simulate(std::size_t n, int from, float grid, int runs) {
    std::mt19937_64 random(n + static_cast<std::size_t>(from + 2) * 1000);
    std::normal_distribution<float> normal;
    std::vector<int> delays;
    for (int run = 0; run < runs; ++run) {
        const auto score = [&](bool shifted) {
            const float x = normal(random) + (shifted ? 1.0F : 0.0F);
            return grid > 0 ? std::round(x / grid) * grid : x;
        };
        std::vector<float> scores;
        for (std::size_t i = 0; i < n; ++i) scores.push_back(score(false));
        const DriftCells cells = cells_of(scores, 0.01);
        Drift drift(cells);
        const int first = std::max(from, 1);
        for (int episode = 1; episode < first + 500 && !drift.alarm(cells); ++episode) {
            end(drift, score(from > 0 && episode >= from), cells);
            if (drift.alarm(cells)) delays.push_back(episode - first + 1);
        }
    }
    std::sort(delays.begin(), delays.end());
    return {static_cast<double>(delays.size()) / runs,
            delays.empty() ? 0 : delays[delays.size() / 2]};
}

int runs_of(int usual) {
    return std::getenv("ETLC_EFFORT") != nullptr ? 100'000 : usual;
}

TEST(Drift, FalseAlarmsKeepTheLevel) {
    const int runs = runs_of(1000);
    // The probability of more, if the level held just so, is 1e-4.
    const double most = 0.01 + 3.72 * std::sqrt(0.01 * 0.99 / runs);
    for (const float grid : {0.0F, 1.0F, 3.0F})
        for (const std::size_t n : {20U, 40U, 100U, 400U}) {
            const Found found = simulate(n, -1, grid, runs);
            EXPECT_LE(found.share, most) << n << " scores on a grid of " << grid;
            std::printf("n = %zu, grid %g: false alarms %.5f\n", n, static_cast<double>(grid),
                        found.share);
        }
}

TEST(Drift, ShiftsAreFoundInTime) {
    const int runs = runs_of(400);
    struct Expected {
        std::size_t n;
        double share;
        int median;
    };
    for (const auto& [n, share, median] :
         {Expected{20, 0.76, 45}, {40, 0.99, 44}, {100, 1, 41}, {400, 1, 39}}) {
        const Found first = simulate(n, 1, 0, runs);
        EXPECT_NEAR(first.share, share, 0.07) << n;
        const Found later = simulate(n, 100, 0, runs);
        EXPECT_GE(later.share, 0.995) << n;
        EXPECT_NEAR(later.median, median, 5) << n;
        std::printf("n = %zu: from episode 1 found %.4f; from 100 found %.4f, median delay %d\n", n,
                    first.share, later.share, later.median);
    }
}

/// Scores that always tie say nothing: whatever a tie is taken for, it must not look like a drift.
TEST(Drift, TiesAreNoDrift) {
    int alarms = 0;
    for (int run = 0; run < 400; ++run) {
        const std::vector<float> scores(20 + static_cast<std::size_t>(run) % 30,
                                        static_cast<float>(run));
        const DriftCells cells = cells_of(scores, 0.05);
        Drift drift(cells);
        for (int episode = 0; episode < 500; ++episode) end(drift, scores[0], cells);
        alarms += drift.alarm(cells) ? 1 : 0;
    }
    EXPECT_LE(alarms, 400 * 0.05 + 3.72 * std::sqrt(400 * 0.05 * 0.95));
}

std::vector<float> ascending(std::size_t n) {
    std::vector<float> scores(n);
    std::iota(scores.begin(), scores.end(), 0.0F);
    return scores;
}

TEST(Drift, OnlyRegularEndsCount) {
    const DriftCells cells = cells_of(ascending(20), 0.01);
    Drift drift(cells);
    drift.see(100);
    drift.begin();  // reset() in mid-episode
    drift.end(cells);
    EXPECT_EQ(drift.state().episodes(), 0U);  // nothing was seen since
    drift.see(etlmon::kMissing);
    drift.end(cells);
    EXPECT_EQ(drift.state().episodes(), 0U);  // and a missing sample has no score
    drift.see(3);
    drift.see(100);
    drift.see(5);
    drift.see(etlmon::kMissing);
    drift.end(cells);
    EXPECT_EQ(drift.state().counts[7], 1U);  // the greatest of its steps
    drift.see(-kInfinity);
    drift.end(cells);
    EXPECT_EQ(drift.state().counts[0], 1U);
    EXPECT_EQ(drift.state().episodes(), 2U);
}

TEST(Drift, AnAlarmStays) {
    const DriftCells cells = cells_of(ascending(40), 0.01);
    Drift drift(cells);
    int first = 0;
    for (int episode = 1; episode < 5000; ++episode) {
        end(drift, 100, cells);
        if (first == 0 && drift.alarm(cells)) first = episode;
        EXPECT_EQ(drift.alarm(cells), first > 0);
    }
    EXPECT_GT(first, 5);
    EXPECT_LT(first, 30);
    EXPECT_EQ(drift.state().episodes(), static_cast<std::uint32_t>(first));
}

TEST(Drift, SurvivesAReboot) {
    const DriftCells cells = cells_of(ascending(40), 0.01);
    Drift before(cells);
    for (int episode = 0; episode < 12; ++episode) end(before, static_cast<float>(episode), cells);
    Drift after(cells);
    ASSERT_TRUE(after.restore(before.state(), cells));
    for (int episode = 0; episode < 12; ++episode) {
        end(before, 30, cells);
        end(after, 30, cells);
    }
    EXPECT_EQ(before.state().wealth(), after.state().wealth());
    EXPECT_EQ(before.state().random, after.state().random);

    DriftState erased;
    std::fill_n(reinterpret_cast<unsigned char*>(&erased), sizeof erased, 0xFF);
    DriftState zeros{};
    DriftState infinite = before.state();
    infinite.accounts[1] = kInfinity;
    DriftState negative = before.state();
    negative.accounts[2] = -1;
    const DriftCells others = cells_of(ascending(41), 0.01);
    for (const DriftState& bad : {erased, zeros, infinite, negative, Drift::first(others)})
        EXPECT_FALSE(after.restore(bad, cells));
    EXPECT_EQ(before.state().wealth(), after.state().wealth());
    EXPECT_TRUE(after.restore(Drift::first(cells), cells));
    EXPECT_FLOAT_EQ(after.state().wealth(), 1);
    static_assert(sizeof(Drift) <= 64);
}

}  // namespace
