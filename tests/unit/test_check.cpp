// Tests the model as a whole: inputs, targets, weights, thresholds, names.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "check/guarantees/provenance.hpp"
#include "check/names/reserved.hpp"
#include "checking.hpp"

namespace etlc::check {
namespace {

namespace fs = std::filesystem;

const fs::path kCases = fs::path(ETLC_SOURCE_DIR) / "tests" / "spec" / "error";

TEST(Check, InputsOfEveryType) {
    const Checked checked(
        "spec t; input a, b : f32 in [-1, inf] hold 3; input c : bool; input d : f32[5]; input e : "
        "f16[6] hold 1; input f : i8[7] scale 0.1;"
        "target t5 = load(\"none.npy\"); monitor m = G (c && a > 0 && b > 0);");
    EXPECT_EQ(checked.codes(), "E0401");
    const Checked good(
        "spec t; input a, b : f32 in [-1, inf] hold 3; input c : bool; input d : f32[5]; input e : "
        "f16[6] hold 1; input f : i8[7] scale 0.1;"
        "monitor m = G (c && a > 0 && b > 0);");
    ASSERT_TRUE(good.model) << good.diagnostics();
    const std::vector<Input>& inputs = good.model->inputs;
    ASSERT_EQ(inputs.size(), 6U);
    EXPECT_EQ(inputs[1].name, "b");
    EXPECT_EQ(inputs[1].hold, 3U);
    EXPECT_TRUE(inputs[1].has_range);
    EXPECT_EQ(inputs[1].range.low, -1.0F);
    EXPECT_EQ(inputs[2].type, InputType::boolean);
    EXPECT_EQ(inputs[3].dimension, 5U);
    EXPECT_EQ(inputs[4].type, InputType::f16);
    EXPECT_EQ(inputs[4].hold, 1U);
    EXPECT_EQ(inputs[5].scale, 0.1F);
    EXPECT_EQ(good.codes(), "W0201 W0201 W0201");
}

TEST(Check, TargetsAndDependencies) {
    const std::string path = (kCases / "t.etl").string();
    const Checked checked(
        "spec t; input z : f32[2]; target row = load(\"row.npy\"); target corner = [[0.1, -2]];"
        "predicate p = mahalanobis(load(\"./row.npy\"))(z, corner) <= 1; predicate q = l2(z, row) "
        "< 1; monitor m = F (p && q);",
        {}, path);
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Model& model = *checked.model;
    EXPECT_EQ(model.targets[0].rows, 1U);
    EXPECT_EQ(model.targets[0].dimension, 2U);
    EXPECT_EQ(model.targets[0].values, (std::vector<float>{1, 2}));
    EXPECT_EQ(model.targets[0].origin, "row.npy");
    EXPECT_EQ(model.targets[1].values, (std::vector<float>{0.1F, -2}));
    EXPECT_EQ(model.targets[1].origin, "literal");
    EXPECT_EQ(model.dependencies, std::vector<std::string>{(kCases / "row.npy").string()});
    EXPECT_TRUE(model.distances[0].weights_diagonal);
    EXPECT_EQ(model.distances[0].weights_path, (kCases / "row.npy").string());
}

TEST(Check, WeightsAreMadeSymmetric) {
    const Checked checked(
        "spec t; input z : f32[2]; target c = [[1, 2]];"
        "monitor m = F mahalanobis([[2, 0.5], [0.500001, 2]])(z, c) < 1;");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const std::vector<float>& w = checked.model->distances[0].weights;
    ASSERT_EQ(w.size(), 4U);
    EXPECT_EQ(w[1], w[2]);
    EXPECT_NEAR(w[1], 0.5000005, 1e-7);
    EXPECT_FALSE(checked.model->distances[0].weights_diagonal);
}

TEST(Check, WeightsFromATarget) {
    const Checked checked(
        "spec t; input z : f32[2]; target c = [[1, 2]]; target w = [[2, -1], [-1, 2]]; target d = "
        "[[3, 4]];"
        "monitor m = F (mahalanobis(w)(z, c) < 1 && mahalanobis(d)(z, c) < 1);");
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_EQ(checked.model->distances[0].weights, (std::vector<float>{2, -1, -1, 2}));
    EXPECT_EQ(checked.model->distances[1].weights, (std::vector<float>{3, 4}));
    EXPECT_TRUE(checked.model->distances[1].weights_diagonal);
}

/// A random matrix A gives the positive definite A A^T + I, and with a negated pivot one that is
/// not positive definite.
TEST(Check, DefinitenessOfRandomMatrices) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int round = 0; round < 20; ++round) {
        constexpr int n = 6;
        double a[n][n];
        for (auto& row : a)
            for (double& x : row) x = normal(random);
        const auto text = [&](double last) {
            std::ostringstream out;
            out.precision(9);
            for (int i = 0; i < n; ++i) {
                out << (i == 0 ? "[[" : ", [");
                for (int j = 0; j < n; ++j) {
                    double w = i == j ? 1 : 0;
                    for (int k = 0; k < n; ++k) w += a[i][k] * a[j][k] * (k == n - 1 ? last : 1.0);
                    out << (j == 0 ? "" : ", ") << std::fixed << w;
                }
                out << "]";
            }
            return "spec t; input z : f32[6]; target c = [[1, 2, 3, 4, 5, 6]]; monitor m = F "
                   "mahalanobis(" +
                   out.str() + "])(z, c) < 1;";
        };
        EXPECT_EQ(Checked(text(1)).codes(), "");
        EXPECT_EQ(Checked(text(-100)).codes(), "E0459");
    }
}

// ---- thresholds ---------------------------------------------------------------------------------

constexpr const char* kCalibrated =
    "spec t; input z : f32[1]; target goal = [[1]]; predicate a = l2(z, goal) <= "
    "calibrated(conformal, alpha = 0.10);"
    "monitor m = F a;";

TEST(Thresholds, EpsilonComesFromTheFile) {
    const std::string file = (kCases / "E0652_threshold_stale.thresholds.json").string();
    const Checked checked(
        "spec t; input z : f32[1]; target goal = [[1]]; predicate good = l2(z, goal) <= "
        "calibrated(conformal, alpha = 0.10); monitor m = F good;",
        {.thresholds_path = file});
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    const Predicate& good = checked.predicate("good");
    EXPECT_EQ(good.threshold.value, 0.5F);
    EXPECT_EQ(good.threshold.value64, 0.5);
    EXPECT_EQ(good.threshold.origin, ThresholdOrigin::conformal);
    EXPECT_EQ(good.threshold.text, "calibrated(conformal, alpha = 0.10)");
    EXPECT_EQ(good.threshold.alpha, "0.10");
    EXPECT_EQ(good.robustness.high, 0.5F);
    EXPECT_EQ(checked.model->dependencies, std::vector<std::string>{file});
}

TEST(Thresholds, UncalibratedIsAllowedForCalibration) {
    const Checked checked(kCalibrated, {.allow_uncalibrated = true});
    ASSERT_TRUE(checked.model) << checked.diagnostics();
    EXPECT_TRUE(std::isnan(checked.predicate("a").threshold.value));
    EXPECT_TRUE(std::isinf(checked.predicate("a").robustness.low));
    EXPECT_EQ(Checked(kCalibrated).codes(), "E0650");
}

TEST(Thresholds, ANamedFileMustBeThere) {
    EXPECT_EQ(Checked(kCalibrated, {.thresholds_path = "no/such/file.json"}).codes(), "E0601");
}

Reads read_for(const std::string& text, const std::string& predicate) {
    const Checked checked(text, {.allow_uncalibrated = true});
    EXPECT_TRUE(checked.model) << checked.diagnostics();
    for (Index i = 0; checked.model && i < checked.model->predicates.size(); ++i)
        if (checked.model->predicates[i].name == predicate) return reads(*checked.model, i);
    return {};
}

TEST(Thresholds, ReadsSayAllThatTheThresholdDependsOn) {
    const std::string head =
        "spec t; input z : i8[1] scale 0.5; input px : f32; target goal = [[1]]; target spot = "
        "[[0]]; predicate held = px > 0.25;";
    const Reads found =
        read_for(head +
                     "predicate a = mahalanobis([2])(z, goal) <= calibrated(f1); let sure = held "
                     "|| false; truth a = sure && l2([px], spot) < 0.50; monitor m = F a;",
                 "a");
    const std::string distance = "mahalanobis([2])(z, goal)";
    const std::string near = "l2([px], spot) < 0.50";
    EXPECT_EQ(found.at("predicate a"), distance + " <=");
    EXPECT_EQ(found.at("truth a"), "(held || false) && " + near);
    EXPECT_EQ(found.at("predicate held"), "px > 0.25");
    EXPECT_EQ(found.at("predicate " + near), "l2([px], spot) < 0.5");
    EXPECT_EQ(found.at("input z"), "i8[1] scale 0.5");
    EXPECT_EQ(found.at("distance " + distance)
                  .find("min 1 mahalanobis from z to goal, diagonal, "
                        "weights #"),
              0U);
    for (const char* target : {"target goal", "target spot"})
        EXPECT_EQ(found.at(target).find("1 x 1, values #"), 0U);
    EXPECT_EQ(found.size(), 10U);
}

/// Long formulas contain names of lets, whose definitions count too.
TEST(Thresholds, ReadsOfALongFormulaHaveItsLets) {
    std::string text =
        "spec t; input x, y : f32; predicate a = x <= calibrated(f1); let l0 = y > 1 && O y > 2;";
    for (int i = 1; i < 12; ++i) text += fmt::format("let l{0} = l{1} && O l{1};", i, i - 1);
    text += "truth a = O l11; monitor m = F a;";
    const Reads found = read_for(text, "a");
    EXPECT_EQ(found.at("truth a"), "O l11");
    EXPECT_EQ(found.at("let l11"), "l10 && O l10");
    EXPECT_EQ(found.at("let l0"), "y > 1 && O y > 2");
    text.replace(text.find("y > 2"), 5, "y > 3");
    EXPECT_NE(found.at("let l0"), read_for(text, "a").at("let l0"));
}

TEST(Thresholds, DifferencesSayWhatChanged) {
    const Reads then{{"input z", "f32[2]"},
                     {"predicate p", "l2(z, g) <="},
                     {"target g", "1 x 2, values #0123456789abcdef"},
                     {"truth p", "an array or table in place of y > 1"}};
    const auto now = [&](const std::string& key, const std::string& text) {
        Reads changed = then;
        changed[key] = text;
        changed["truth p"] = key == "truth p" ? text : "y > 1";
        return differences(then, changed);
    };
    using Notes = std::vector<std::string>;
    EXPECT_EQ(now("truth p", "y > 1"), Notes{});
    EXPECT_EQ(now("truth p", "y > 2"),
              Notes{"truth p was: an array or table in place of y > 1; it is: y > 2"});
    EXPECT_EQ(now("predicate p", "l2(z, g) <"),
              Notes{"predicate p was: l2(z, g) <=; it is: l2(z, g) <"});
    EXPECT_EQ(now("target g", "1 x 2, values #ffffffffffffffff"),
              Notes{"the values of target g changed"});
    EXPECT_EQ(now("target g", "2 x 2, values #ffffffffffffffff"),
              Notes{"target g was: 1 x 2; it is: 2 x 2"});
    EXPECT_EQ(now("rate", "0.1 s a step"), Notes{"rate was: not read; it is: 0.1 s a step"});
    EXPECT_TRUE(replaces_truths(then));
    EXPECT_FALSE(replaces_truths({{"truth p", "an array or table"}, {"input x", "f32"}}));
}

// ---- names --------------------------------------------------------------------------------------

TEST(Names, SuggestionsMayBeDeclared) {
    for (const char* name : {"int", "co_await", "NAN", "FLT_MAX", "a__b", "__", "_Up", "__x",
                             "step", "Monitor", "signal", "int__", "___9", "EOF"}) {
        for (const char* kind : {"input", "spec", "monitor"}) {
            const bool is_namespace = std::string(kind) == "spec";
            if (!why_forbidden(name, is_namespace)) continue;
            const std::string suggestion = allowed_name(name, kind, is_namespace);
            EXPECT_FALSE(why_forbidden(suggestion, is_namespace)) << name << " -> " << suggestion;
            EXPECT_NE(suggestion, name);
        }
    }
}

TEST(Names, OrdinaryNamesPass) {
    for (const char* name : {"x", "z", "at_goal", "near", "far", "gripper", "time", "index", "log",
                             "min_distance", "I2", "reach_avoid", "final", "module"})
        EXPECT_FALSE(why_forbidden(name, false)) << name;
    EXPECT_FALSE(why_forbidden("dubins", true));
    EXPECT_TRUE(why_forbidden("time", true));
    EXPECT_FALSE(why_forbidden("times_two", true));
}

TEST(Names, UnderscoresStandBetweenOthers) {
    for (const char* name : {"_x", "x_", "a__b", "_X", "step_", "_"})
        EXPECT_TRUE(why_forbidden(name, false)) << name;
    EXPECT_EQ(allowed_name("finished_", "input", false), "finished");
    EXPECT_EQ(allowed_name("_a__b_", "input", false), "a_b");
}

TEST(Names, CapitalsAreLeftToMacros) {
    for (const char* name : {"NAN", "SPI1", "A_B", "FLT_MAX", "PRIu8"})
        EXPECT_TRUE(why_forbidden(name, false)) << name;
    EXPECT_EQ(allowed_name("IMU", "input", false), "imu");
}

TEST(Names, AreDeclaredInAnyOrder) {
    const Checked checked(
        "spec t; monitor m = F l; let l = p; predicate p = min l2(z, goal) <= 1; target goal = "
        "[[1, 2]]; input z : f32[2];");
    EXPECT_EQ(checked.codes(), "") << checked.diagnostics();
}

// ---- robustness ---------------------------------------------------------------------------------

/// Specs with lost, doubled or exchanged pieces: their errors are reported, and nothing crashes.
TEST(Check, BearsDamagedSpecs) {
    std::vector<std::string> specs;
    for (const char* folder : {"error", "ok"})
        for (const auto& entry :
             fs::directory_iterator(fs::path(ETLC_SOURCE_DIR) / "tests" / "spec" / folder)) {
            if (entry.path().extension() != ".etl" || entry.file_size() > 4000) continue;
            std::ifstream in(entry.path());
            std::ostringstream text;
            text << in.rdbuf();
            specs.push_back(text.str());
        }
    ASSERT_GT(specs.size(), 40U);
    std::sort(specs.begin(), specs.end());
    std::mt19937 random(2);
    const std::string path = (kCases / "t.etl").string();
    int with_model = 0;
    for (int i = 0; i < 1500; ++i) {
        std::string text = specs[random() % specs.size()];
        for (int edit = i % 4; edit > 0; --edit) {
            const std::size_t at = random() % text.size();
            const std::string& other = specs[random() % specs.size()];
            const std::size_t from = random() % other.size();
            text.replace(at, random() % 12, other.substr(from, random() % 12));
            if (text.empty()) text.push_back('s');
        }
        const Checked checked(text, {}, path);
        EXPECT_EQ(checked.model.has_value(), !checked.sink.has_errors());
        if (checked.model) ++with_model;
    }
    EXPECT_GT(with_model, 10);
}

}  // namespace
}  // namespace etlc::check
