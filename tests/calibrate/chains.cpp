#include "chains.hpp"

#include <fmt/format.h>

#include <cmath>

namespace etlc::tests {

namespace {

constexpr int kSteps = 7;

std::string threshold_of(Method method, const std::string& alpha, Random& random) {
    switch (method) {
        case Method::f1:
        case Method::whole_of_f1: return "calibrated(f1)";
        case Method::conformal:
            return fmt::format("calibrated(conformal, alpha = {}{}{})", alpha,
                               random.word({"", "", ", against = false_positives",
                                            ", against = both", ", beta = 0.15, against = both"}),
                               random.word({"", "", ", within = 1 steps"}));
        case Method::class_conditional:
            return fmt::format("calibrated(class_conditional, alpha = {})", alpha);
        case Method::adaptive:
            return fmt::format("calibrated(adaptive, alpha = {}, gamma = 0.1, lo = -99, hi = 99)",
                               alpha);
        case Method::whole: break;
    }
    return random.word({"0.4", "0.7", "1.1"});
}

/// Returns a truth that the methods allow.
std::string truth_of(const World& world, Random& random) {
    std::vector<std::string> all{"y > limit", "y > limit || b && y > 0.2", "high",
                                 "y > limit && l2([x, y], k) < 1.5"};
    if (!world.frames_alike) all.emplace_back("O[0, 0.1 s] (y > limit)");
    return random.pick(all);
}

std::string monitor_of(Method method, const std::string& alpha, Random& random) {
    const std::vector<std::string> formulas{
        "F[0, 0.2 s] (a && own)", "G[0, 0.3 s] (a -> F[0, 0.1 s] own)",
        "F[0, 0.2 s] (a && b)",   "F[0, 0.3 s] a",
        "G[0, 0.2 s] !a",         "G[0, 0.4 s] (!a || !own)"};
    if (method != Method::whole && method != Method::whole_of_f1)
        return "monitor m = " +
               random.word({"F a", "G !a", "F[0, 0.2 s] (a && own)", "G (!a || own)"});
    return fmt::format("{}monitor m = {} calibrated(conformal, alpha = {}, against = {}{})",
                       random.chance(0.3) ? "sliding " : "", random.pick(formulas), alpha,
                       random.word({"missed_alarm", "missed_success", "both"}),
                       random.word({"", "", ", within = 1 steps"}));
}

const std::vector<Edit>& edits() {
    static const std::vector<Edit> all{
        {"own = x <= 1.1 missing true", "own = x <= 1.1 missing false"},
        {"own = x <= 1.1 missing false", "own = x <= 1.1"},
        {"own = x <= 1.1;", "own = x <= 1.1 missing true;"},
        {"bool missing true", "bool missing false"},
        {"bool missing false", "bool"},
        {"bool;", "bool missing true;"},
        {" missing true;\ntruth", " missing false;\ntruth"},
        {" missing false;\ntruth", " missing true;\ntruth"},
        {" missing false;\nmonitor", " missing true;\nmonitor"},
        {"sliding monitor", "monitor"},
        {"\nmonitor m = F[0", "\nsliding monitor m = F[0"},
        {"\nmonitor m = G[0", "\nsliding monitor m = G[0"},
        {"limit = 0.5", "limit = 0.1"},
        {"truth a = y > limit", "truth a = y > 0.1"},
        {"truth a = high", "truth a = y >= limit"},
        {"y > limit || b", "y > limit || !b"},
        {"O[0, 0.1 s]", "O[0, 0.4 s]"},
        {"\nmonitor", "\ntruth a = y > 0.2;\nmonitor"},
        {"\nsliding monitor", "\ntruth a = y > 0.2;\nsliding monitor"},
        {"truth a", "truth own = y <= 1.1; truth a"},
        {"truth a = high;\n", ""},
        {"truth a = y > limit;\n", ""},
        {"x <= 1.1", "x <= 0.6"},
        {"x <= 1.1", "x < 1.1"},
        {" in [-3, 3]", " in [-3, 0.6]"},
        {"z : f32[2] hold 1", "z : f32[2]"},
        {"z : f32[2];", "z : f32[2] hold 2;"},
        {"x : f32;", "x : f32 hold 3;"},
        {"x : f32;", "x : f32, stale after 1;"},
        {"z : f32[2];", "z : f32[2], stale after 2;"},
        {"z : f32[2]", "z : f16[2]"},
        {"[[1, 0.5]", "[[1, 2]"},
        {"g = [[1, 0]", "g = [[0.2, 0]"},
        {" of Q(z);", ";"},
        {"]];\npredicate a = min l2(Q(z)", "]] of Q(z);\npredicate a = min l2(Q(z)"},
        {"min l2(", "max l2("},
        {"max l2(", "min l2("},
        {"mean l1", "mean l2"},
        {"(z, g)", "([x, y], g)"},
        {"(Q(z), g)", "(z, g)"},
        {"- 0.3 * x", "- 0.6 * x"},
        {"g) <=", "g) <"},
        {"g) <", "g) - 0.1 <"},
        {"<= 0.7", "<= 1"},
        {"rate 10 Hz", "rate 20 Hz"},
        {"rate 10 Hz", "period 100 ms"},
        {"F[0, 0.2 s]", "F[0, 0.5 s]"},
        {"G[0, 0.2 s]", "G[0, 0.1 s]"},
        {"(a && own)", "(a || own)"},
        {"(a && b)", "(a && !b)"},
        {"-> F[0, 0.1 s] own", "-> F[0, 0.1 s] b"},
        {"against = missed_alarm", "against = missed_success"},
        {"against = missed_alarm", "against = both"},
        {", against = both", ", against = false_positives"},
        {", against = false_positives", ""},
        {", beta = 0.15", ", beta = 0.2"},
        {", within = 1 steps", ", within = 2 steps"},
        {"alpha = 0.3", "alpha = 0.1"},
        {"f1)", "conformal, alpha = 0.1)"},
        {"class_conditional", "conformal"},
        {"lo = -99", "lo = -98"},
        {"gamma = 0.1", "gamma = 0.2"},
        {"where = a && own", "where = a"},
        {"where = a)", "where = !a)"},
        {"r = 2, of = z", "r = 2, of = [x, y]"},
        {"spec t;", "spec t; // a remark\n"},
        {"predicate own", "let unused = high; predicate own"},
    };
    return all;
}

}  // namespace

std::string episode_of(const World& world, bool with_array, Random& random) {
    const auto normal = [&] {
        return std::sqrt(-2 * std::log(1 - random.uniform())) *
               std::cos(6.2831853 * random.uniform());
    };
    std::string text = with_array ? "x,y,z[0],z[1],b,truth.a\n" : "x,y,z[0],z[1],b\n";
    double y = 0.4 + 0.6 * normal();
    for (int t = 0; t < kSteps; ++t) {
        y = world.frames_alike ? 0.4 + 0.6 * normal() : 0.4 + 0.7 * (y - 0.4) + 0.4 * normal();
        const auto is_there = [&](double missing) { return !random.chance(missing); };
        const std::string x = fmt::format("{:.6f}", y + world.noise * normal());
        const std::string z =
            fmt::format("{:.6f},{:.6f}", y + world.noise * normal(), 0.5 * world.noise * normal());
        const bool b = (y > 0.5) != random.chance(0.2);
        text += is_there(world.missing) ? x : "";
        text += is_there(world.missing_truth) ? fmt::format(",{:.6f},", y) : ",,";
        text += is_there(world.missing) ? z : ",";
        text += is_there(world.missing) ? (b ? ",1" : ",0") : ",";
        if (with_array) text += y + 0.2 * normal() > 0.8 ? ",1" : ",0";
        text += "\n";
    }
    return text;
}

Chain random_chain(Random& random) {
    Chain chain;
    chain.method = random.pick<Method>({Method::f1, Method::conformal, Method::conformal,
                                        Method::class_conditional, Method::adaptive, Method::whole,
                                        Method::whole, Method::whole, Method::whole_of_f1});
    World& world = chain.world;
    world.frames_alike = chain.method == Method::class_conditional || random.chance(0.3);
    world.missing = random.pick<double>({0, 0.15, 0.4});
    world.missing_truth = random.chance(0.3) ? 0.05 : 0;
    world.noise = random.pick<double>({0.1, 0.3, 0.6});
    world.arrays = random.chance(0.3);
    const bool silent = world.arrays && random.chance(0.7);
    const std::string alpha = random.word({"0.1", "0.2", "0.3"});
    const bool keeps = !world.frames_alike;  // `held` makes frames depend on each other

    std::string& spec = chain.spec;
    spec = "spec t; rate 10 Hz; const limit = 0.5;\ninput x : f32";
    spec += random.word({"", " in [-3, 3]"}) + (keeps ? random.word({"", " hold 1"}) : "");
    spec += ";\ninput y : f32;\ninput z : f32[2]" + (keeps ? random.word({"", " hold 1"}) : "");
    spec += ";\ninput b : bool" + random.word({"", " missing true", " missing false"});
    spec += ";\ntarget k = [[0.5, 0.5]]; predicate high = y > limit" +
            random.word({"", " missing true"}) + ";\n";
    spec +=
        "predicate own = x <= 1.1" + random.word({"", " missing true", " missing false"}) + ";\n";
    const std::string point = random.word({"z", "z", "Q(z)"});
    if (point != "z") {
        const bool is_fitted = random.chance(0.4);
        chain.has_fitted |= is_fitted;
        spec += fmt::format("projection Q = {};\n",
                            is_fitted ? random.word({"fitted(pca, r = 2, of = z, where = true)",
                                                     "fitted(logpzo, of = z, where = a)"})
                                      : "[[1, 0.5], [0.2, 1]]");
    }
    const bool fitted_target = random.chance(0.25);
    chain.has_fitted |= fitted_target;
    spec += fmt::format(
        "target g = {}{};\n",
        fitted_target ? random.word({"fitted(mean, of = " + point + ", where = a)",
                                     "fitted(kmeans, k = 2, of = " + point + ", where = a && own)"})
                      : random.word({"[[1, 0]]", "[[1, 0], [0.8, 0.3]]"}),
        fitted_target || point == "z" || random.chance(0.5) ? "" : " of " + point);
    const std::string measure = random.word({"min l2", "max l2", "mean l1", "min linf"}) + "(" +
                                point + ", g)" + random.word({"", "", " - 0.3 * x"});
    spec += fmt::format("predicate a = {} {} {}{};\n", measure, random.word({"<=", "<"}),
                        threshold_of(chain.method, alpha, random),
                        random.word({"", "", " missing true", " missing false"}));
    if (!silent) spec += "truth a = " + truth_of(world, random) + ";\n";
    spec += monitor_of(chain.method, alpha, random) + ";";
    return chain;
}

Edit random_edit(const std::string& spec, Random& random) {
    if (random.chance(0.15)) return {};
    std::vector<Edit> all;
    for (const Edit& edit : edits())
        if (spec.find(edit.from) != std::string::npos) all.push_back(edit);
    return random.pick(all);
}

}  // namespace etlc::tests
