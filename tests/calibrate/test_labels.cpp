// Tests labels and identity of episodes.
#include <gtest/gtest.h>

#include "check/check.hpp"
#include "episodes.hpp"
#include "parse/parse.hpp"

namespace etlc::tests {
namespace {

using episodes::Recording;
using episodes::Wanted;

constexpr const char* kSpec =
    "spec t; input x : f32; input v : f32; input px : f32;\n"
    "predicate p = x <= calibrated(f1); predicate q = v <= 1;\n"
    "truth p = O[0, 1] (px < 0.25);\n"
    "monitor m = F p && G q;";

struct Labels : testing::Test {
    check::Model model;
    Wanted wanted;

    Labels() {
        diag::Sink sink;
        const source::File file("t.etl", kSpec);
        check::Options options;
        options.allow_uncalibrated = true;
        model = *check::check(parse::parse(file, sink), file, options, sink);
        wanted = {&model, {0, 1}, {0}, episodes::identity_inputs(model)};
    }
};

TEST_F(Labels, FromTheSpecsTruth) {
    EXPECT_EQ(
        labels(wanted, csv_episode("x,v,px\n1,1,0\n1,1,1\n1,1,1\n1,1,0.25\n1,1,\n1,1,0\n"), 0),
        "y y n n ? y");
}

TEST_F(Labels, AnArrayStandsInForTheTruth) {
    EXPECT_EQ(labels(wanted, csv_episode("x,v,truth.p,px\n1,1,0,0\n1,1,1,0\n1,1,,0\n"), 0),
              "n y ?");
    // Then inputs that only the truth reads may be absent.
    EXPECT_EQ(labels(wanted, csv_episode("x,v,truth.p\n1,1,1\n"), 0), "y");
    auto recording = Recording::open(wanted, csv_episode("x,v,truth.p\n1,1,1\n"));
    ASSERT_TRUE(recording);
    EXPECT_TRUE(recording->from_array(0));
    auto other = Recording::open(wanted, csv_episode("x,v,px\n1,1,1\n"));
    ASSERT_TRUE(other);
    EXPECT_FALSE(other->from_array(0));
}

TEST_F(Labels, MessagesWhereTheyAreLacking) {
    EXPECT_EQ(labels(wanted, csv_episode("x,v\n1,1\n"), 0), "no column 'px'; did you mean 'x'?");
    EXPECT_EQ(labels(wanted, csv_episode("v,px\n1,1\n"), 0), "no column 'x'; did you mean 'px'?");
    EXPECT_EQ(labels(wanted, csv_episode("x,v,px,truth.p\n1,1,1,2\n"), 0),
              "column 'truth.p' holds '2', expected 0 or 1, True or False");
    wanted.predicates = {1};
    EXPECT_EQ(
        labels(wanted, csv_episode("x,v\n1,1\n"), 1),
        "does not say when 'q' holds, and the spec has no truth for it: no column 'truth.q'; there "
        "are 'x' and 'v'");
    EXPECT_EQ(labels(wanted, csv_episode("x,v,truth.q\n1,1,1\n"), 1), "y");
}

TEST_F(Labels, SamplesAreWhatTheMonitorIsGiven) {
    auto recording = Recording::open(wanted, csv_episode("x,v,px\n0.1,,0\n"));
    ASSERT_TRUE(recording);
    ASSERT_TRUE(*recording->next());
    EXPECT_EQ(recording->samples()[0].values, std::vector<float>{0.1F});
    EXPECT_FALSE(recording->samples()[1].present);
    EXPECT_FALSE(*recording->next());
    EXPECT_EQ(recording->frames(), 1U);
}

std::string hash(const Wanted& wanted, const std::string& text) {
    auto recording = Recording::open(wanted, csv_episode(text));
    while (*recording->next()) {
    }
    return recording->recorded().hash;
}

TEST_F(Labels, AnEpisodeIsWhatItsCalibratedPredicatesRead) {
    const std::string original = hash(wanted, "x,v,px\n1,2,3\n4,5,6\n");
    EXPECT_EQ(hash(wanted, "px,x,v\n0,1.0,\n0,4,7\n"),
              original);  // other labels, another input, but the same scores
    EXPECT_NE(hash(wanted, "x,v,px\n1,2,3\n4.5,5,6\n"), original);
    EXPECT_NE(hash(wanted, "x,v,px\n4,5,6\n1,2,3\n"), original);
    EXPECT_NE(hash(wanted, "x,v,px\n1,2,3\n"), original);
    EXPECT_NE(hash(wanted, "x,v,px\n1,2,3\n4,5,6\n,,\n"), original);
    EXPECT_EQ(hash(wanted, "x,v,px\n1,2,3\nnan,5,6\n"), hash(wanted, "x,v,px\n1,2,3\n,5,6\n"));
}

}  // namespace
}  // namespace etlc::tests
