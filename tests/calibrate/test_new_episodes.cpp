// Checks guarantees on new episodes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "check/guarantees/guarantees.hpp"
#include "compile.hpp"
#include "driver/commands/commands.hpp"
#include "episodes/truth.hpp"
#include "execute/evaluator.hpp"
#include "random.hpp"
#include "roads.hpp"

namespace etlc::tests {
namespace {

constexpr int kNewEpisodeDraws = 120;
constexpr int kFresh = 8;  ///< episodes per draw

/// x is near 0 where the label holds; s may lie exactly on the threshold of its comparisons.
struct Drawn {
    std::vector<float> x, s;
    std::vector<bool> label;

    explicit Drawn(Random& random) {
        const double share = random.uniform();
        for (int t = 0; t < 6; ++t) {
            label.push_back(random.chance(share));
            double noise = 0;
            for (int i = 0; i < 4; ++i) noise += random.uniform() - 0.5;
            x.push_back(static_cast<float>((label.back() ? 0 : 1) + 0.8 * noise));
            s.push_back(random.pick(std::vector<float>{0.25F, 0.5F, 0.5F, 1}));
        }
    }

    std::string csv() const {
        std::string text = "x,s,truth.a\n";
        for (std::size_t t = 0; t < x.size(); ++t)
            text += fmt::format("{},{},{}\n", x[t], s[t], label[t] ? 1 : 0);
        return text;
    }
};

std::vector<std::string> drawn(Random& random, int count) {
    std::vector<std::string> episodes;
    for (int i = 0; i < count; ++i) episodes.push_back(Drawn(random).csv());
    return episodes;
}

/// For every monitor with a guarantee: the number of fresh episodes, and of those with a verdict
/// that the guarantee excludes.
struct Tally {
    check::Guarantee guarantee;
    int episodes = 0;
    int broken = 0;
};

/// `zero_aside`: ignore verdicts with robustness 0.
bool breaks(const check::Guarantee& guarantee, const etlmon::Verdict& predicted,
            const etlmon::Verdict& actual) {
    const bool alarm = actual.violated() && predicted.satisfied() &&
                       !(guarantee.zero_aside && predicted.robustness == 0);
    const bool success = actual.satisfied() && predicted.violated();
    switch (guarantee.kind) {
        case check::Guarantee::Kind::missed_success: return success;
        case check::Guarantee::Kind::missed_alarm: return alarm;
        case check::Guarantee::Kind::exact: return success || alarm;
        default: break;
    }
    return false;
}

void count(const Compiled& monitors, const Compiled& truths, Random& random,
           std::map<std::string, Tally>& kept) {
    execute::Evaluator predicted(monitors.plan);
    execute::Evaluator actual(truths.plan);
    const Drawn episode(random);
    std::set<std::string> broken;
    for (std::size_t t = 0; t < episode.x.size(); ++t) {
        std::vector<execute::Sample> samples{{true, {episode.x[t]}}, {true, {episode.s[t]}}};
        const auto& verdicts = predicted.step(samples);
        samples.push_back({true, {episode.label[t] ? 1.0F : 0.0F}});
        const auto& truth = actual.step(samples);
        for (std::size_t m = 0; m < verdicts.size(); ++m) {
            const check::Monitor& monitor =
                monitors.model->monitors[monitors.plan.monitors[m].index];
            Tally& of = kept[monitor.name];
            of.guarantee = check::guarantees(*monitors.model, monitor, monitors.plan.values)[0];
            if (breaks(of.guarantee, verdicts[m], truth[m])) broken.insert(monitor.name);
        }
    }
    for (auto& [name, of] : kept) {
        ++of.episodes;
        of.broken += broken.contains(name) ? 1 : 0;
    }
}

/// Calibrates again for every draw. Skips draws with too few scores.
std::map<std::string, Tally> draws(const std::string& spec, bool of_predicates, bool of_monitors,
                                   check::Values values) {
    std::map<std::string, Tally> kept;
    Random random(2027);
    for (int draw = 0; draw < kNewEpisodeDraws; ++draw) {
        std::string thresholds;
        const Files first(drawn(random, 10));
        if (of_predicates) {
            thresholds = calibrated(spec, first.paths()).thresholds;
            if (thresholds.empty()) continue;
        }
        const Files second(drawn(random, 16));
        if (of_monitors) {
            thresholds = calibrated(spec, second.paths(), thresholds).thresholds;
            if (thresholds.empty()) continue;
        }
        const TemporaryPath file("thresholds.json", thresholds);
        driver::Request request;
        request.check.thresholds_path = file.path();
        request.values = values;
        diag::Sink sink;
        const auto monitors = compile(source::File("t.etl", spec), request.check, request, sink);
        if (!monitors) {
            ADD_FAILURE() << thresholds;
            return kept;
        }
        auto truth = episodes::ground_truth(*monitors->model, {0});
        const auto truths = compile(std::move(truth.model), {{}, check::Values::boolean}, sink);
        for (int i = 0; i < kFresh; ++i) count(*monitors, *truths, random, kept);
    }
    return kept;
}

void expect_kept(const std::map<std::string, Tally>& all, const std::string& which) {
    for (const auto& [name, kept] : all) {
        EXPECT_GT(kept.episodes, kNewEpisodeDraws * kFresh / 2) << which;
        const double bound =
            kept.guarantee.bound.empty() || kept.guarantee.kind == check::Guarantee::Kind::exact
                ? 0
                : std::stod(kept.guarantee.bound);
        const double share = static_cast<double>(kept.broken) / kept.episodes;
        EXPECT_LE(share, bound + 3 * std::sqrt(bound * (1 - bound) * kFresh / kept.episodes))
            << which << " " << name << ": " << check::text(kept.guarantee);
    }
}

const std::string kUnions =
    "monitor p0 = F (a && s > 0.5); monitor p1 = G (s > 0.5 -> F[0, 2] a); monitor n0 = G (a -> s "
    "> 0.5);"
    "monitor n1 = G (a -> s >= 0.5); monitor n2 = G !(a && s <= 0.5); sliding monitor n3 = F[0, 2] "
    "!a;"
    "monitor e0 = G s > 0.5; monitor e1 = G s >= 0.5; monitor e2 = F !(s >= 0.5);";
const std::string kWholes =
    "monitor w0 = F (a && s > 0.5) calibrated(conformal, alpha = 0.25, against = missed_alarm);"
    "monitor w1 = F (a && s > 0.5) calibrated(conformal, alpha = 0.25, against = missed_success);"
    "monitor w2 = G (a -> s > 0.5) calibrated(conformal, alpha = 0.25, against = missed_alarm);"
    "sliding monitor w3 = F[0, 2] !a calibrated(conformal, alpha = 0.25, against = missed_alarm);";

std::string drawn_spec(const std::string& threshold, const std::string& monitors) {
    return "spec t; input x, s : f32; predicate a = x <= " + threshold + ";\n" + monitors;
}

TEST(Guarantees, AreKept) {
    using enum check::Values;
    const std::string unions = drawn_spec("calibrated(conformal, alpha = 0.25)", kUnions);
    expect_kept(draws(unions, true, false, robustness), "predicates");
    expect_kept(draws(unions, true, false, boolean), "predicates, boolean");
    expect_kept(draws(drawn_spec("0.5", kWholes), false, true, robustness), "wholes");
    expect_kept(draws(drawn_spec("calibrated(f1)", kWholes), true, true, robustness),
                "wholes of f1");
    expect_kept(
        draws(drawn_spec("calibrated(conformal, alpha = 0.25)", kWholes), true, true, robustness),
        "wholes of conformal");
}

}  // namespace
}  // namespace etlc::tests
