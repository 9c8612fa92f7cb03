#include "whole_specs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace etlc::tests {

namespace {

/// Declarations of all these specs. Scores of `a` depend on every number in them.
const std::string kWorld =
    "spec t; rate 10 Hz; const limit = 0.5;\n"
    "input x : f32 in [-9, 9] hold 1; input y : f32; input z : f32[2]; input b : bool missing "
    "false;\n"
    "projection Q = [[1, 0.5], [0, 1]]; projection V = [[2, 0.5], [0, 1]] offset [[0.1, 0]];\n"
    "target g = [[0, 0], [0.5, 0.1], [0.2, 0.9]]; target h = [[0.3, 0.1]] of V(z);\n"
    "target k = [[0.4, 0.6]]; let seen = O[0, 0.2 s] (b && l2([x, y], k) < 0.4);\n";
const std::string kMeasure = "min l2(Q(z), g) + l1(V(z), h) + kth(2) linf(z, g) - 0.1 * x";

}  // namespace

const std::string kTruth = "truth a = y > limit || (y > 0.2 && seen);\n";
const std::string kOwn = "predicate own = x - y <= 0.8 missing true;\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string of_predicate(const std::string& threshold) {
    return kWorld + "predicate a = " + kMeasure + " <= " + threshold + ";\n" + kTruth + kOwn +
           "monitor m = F (a || own);";
}

std::string of_monitor(const std::string& against) {
    return kWorld + "predicate a = " + kMeasure + " <= 1.9 missing false;\n" + kTruth + kOwn +
           "monitor m = F[0, 0.2 s] (a && own || a && b) calibrated(conformal, alpha = 0.4, "
           "against "
           "= " +
           against + ");";
}

const std::vector<std::string>& predicate_specs() {
    static const std::vector<std::string> all{
        of_predicate("calibrated(f1)"), of_predicate("calibrated(conformal, alpha = 0.2)"),
        of_predicate("calibrated(class_conditional, alpha = 0.2)"),
        of_predicate("calibrated(adaptive, alpha = 0.2, gamma = 0.1, lo = -9, hi = 9)")};
    return all;
}

const std::vector<std::string>& specs() {
    static const std::vector<std::string> all = [] {
        std::vector<std::string> result = predicate_specs();
        for (const char* against : {"missed_alarm", "missed_success"})
            result.push_back(of_monitor(against));
        return result;
    }();
    return all;
}

std::vector<std::string> random_episodes(Random& random, int count, bool label) {
    std::vector<std::string> episodes;
    for (int i = 0; i < count; ++i) {
        std::string text = label ? "x,y,z[0],z[1],b,truth.a\n" : "x,y,z[0],z[1],b\n";
        for (int t = 0; t < 6; ++t) {
            const double y = random.uniform();
            const auto cell = [&](double value) {
                return random.chance(0.15) ? std::string() : fmt::format("{}", value);
            };
            const std::string z = fmt::format("{},{}", 1 - y + 0.3 * random.uniform(), y);
            text += fmt::format("{},{},{},{}", cell(y + 0.8 * random.uniform()), y,
                                random.chance(0.15) ? "," : z,
                                random.chance(0.1)   ? ""
                                : random.chance(0.5) ? "1"
                                                     : "0");
            if (label) text += random.chance(0.5) ? ",1" : ",0";
            text += "\n";
        }
        episodes.push_back(text);
    }
    return episodes;
}

}  // namespace etlc::tests
