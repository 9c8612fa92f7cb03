// Tests the choice of frames of an episode: evenly spaced, at most a given number, and away from
// changes of a truth.
#include <gtest/gtest.h>

#include "fit/collect.hpp"

namespace etlc::fit {
namespace {

/// The steps of an episode, one letter each: + the truth holds, . it does not, ? the point is
/// missing.
std::vector<std::uint64_t> taken(const std::string& episode, std::size_t most, std::uint64_t away) {
    EvenFrames frames(most, away);
    for (std::size_t step = 0; step < episode.size(); ++step) {
        if (episode[step] == '.')
            frames.add_other();
        else
            frames.add(step, episode[step] == '+' ? std::vector<float>{1} : std::vector<float>{});
    }
    std::vector<std::uint64_t> result;
    for (const TakenFrame& frame : frames.take()) result.push_back(frame.step);
    return result;
}

using Steps = std::vector<std::uint64_t>;

TEST(EvenFrames, AreAllWhereTheyAreFew) {
    EXPECT_EQ(taken("+.++?+", 10, 0), (Steps{0, 2, 3, 5}));
}

TEST(EvenFrames, LieAwayFromAChange) {
    EXPECT_EQ(taken("..+++++..", 10, 2), (Steps{4}));
    EXPECT_EQ(taken("+++++..", 10, 2), (Steps{0, 1, 2})) << "before the first, nobody knows";
    EXPECT_EQ(taken("..+++", 10, 1), (Steps{3, 4})) << "nor behind the last";
}

TEST(EvenFrames, AreEvenlySpaced) {
    EXPECT_EQ(taken(std::string(8, '+'), 4, 0), (Steps{0, 2, 4, 6}));
    const Steps steps = taken(std::string(1000, '+'), 7, 0);
    ASSERT_EQ(steps.size(), 7U);
    for (std::size_t i = 1; i < steps.size(); ++i) {
        EXPECT_GE(steps[i] - steps[i - 1], 100U);
        EXPECT_LE(steps[i] - steps[i - 1], 200U);
    }
}

}  // namespace
}  // namespace etlc::fit
